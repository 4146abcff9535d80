#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "optics/reflection_search.h"

namespace symsurf {

namespace {

using std::numbers::pi;

constexpr int pieces = 2;  // samples between two nodes at the least
constexpr int most_halves = 40;
constexpr double newton_from = 1e-3;   // sizes: how near a root Newton is let go
constexpr double no_root_above = 0.3;  // of a sample: a parabola that ends above it has no roots
constexpr int halves_at_end = 12;
constexpr int most_splits = 2000;  // of one search: where rounding is all that moves, it ends
constexpr double smooth = 0.95;    // cosine between neighbouring samples' normals and views
constexpr double far = 30;         // sizes: beyond, the mirror is seen ever more from the side
constexpr double gap = 1e-9;  // of an interval, beside its nodes, where a plane may be singular
constexpr double degenerate = 1e-9;  // of the numbers that are compared

// In the frame of a quadric's axes about the eye: its numbers, and the source.
struct Frame {
  Vector3 curves, linear;
  double constant;
  Vector3 source;
  double greatest = curves.cwiseAbs().maxCoeff();
  double size = source.norm() + extent();

  Vector3 gradient(const Vector3& y) const { return 2 * curves.cwiseProduct(y) + linear; }
  double value(const Vector3& y) const { return y.dot(curves.cwiseProduct(y) + linear) + constant; }
  // How far the quadric is, and how large.
  double extent() const {
    const double slope = linear.norm();
    return (greatest > 0 ? slope / greatest + std::sqrt(std::abs(constant) / greatest) : 0) +
           (slope > 0 ? std::abs(constant) / slope : 0);
  }

  // The quadric's point next to y; false far from any.
  bool operator()(const Vector3& y, SurfacePoint& at) const {
    at.position = y;
    for (int k = 0; k < 3; ++k) {
      const Vector3 g = gradient(at.position);
      at.position -= value(at.position) / g.squaredNorm() * g;
    }
    const Vector3 g = gradient(at.position);
    const double length = g.norm();
    at.normal = g / length;
    const Matrix3 tangent = Matrix3::Identity() - at.normal * at.normal.transpose();
    at.shape = tangent * (2 / length * curves).asDiagonal() * tangent;
    return at.normal.allFinite();
  }
};

// A line p + t q in a plane with the normal m.
struct PlaneLine {
  Vector3 p, q, m;
};

// The two points of the quadric on such a line, and how far each is from the law of reflection.
struct Sample {
  double angle;
  bool is_real;
  struct Branch {
    Vector3 point, normal;
    double law;
    bool is_same_side;  // are both ends, of the tangent plane?
  };
  std::array<Branch, 2> branch;
};

// Searches the points of a family of lines, by an angle.
template <typename Lines>
class Search {
 public:
  Search(const Frame& frame, const Lines& lines, std::vector<SurfacePoint>& found)
      : frame_(frame), path_{frame.source, Vector3::Zero()}, lines_(lines), found_(found) {}

  // Over half a turn; nodes: angles at which the curve begins, ends or is singular.
  void run(std::vector<double> nodes) {
    for (double& node : nodes) node -= pi * std::floor(node / pi);
    std::sort(nodes.begin(), nodes.end());
    if (nodes.empty()) nodes.push_back(0);
    nodes.push_back(nodes.front() + pi);
    constexpr std::size_t samples_mostly = 64;
    curve_.reserve(samples_mostly);
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      const double width = nodes[k + 1] - nodes[k];
      if (width < degenerate) continue;
      Sample before = sample(nodes[k] + gap * width);
      for (int i = 1; i <= pieces; ++i) {
        // Denser towards the nodes, where the points move as the root of the angle.
        const double part = (1 - (1 - 2 * gap) * std::cos(pi * i / pieces)) / 2;
        const Sample after = sample(nodes[k] + part * width);
        between(before, after, 0);
        before = after;
      }
      curve_.push_back(before);
      for (int k = 0; k < 2; ++k) find_roots(k);
      curve_.clear();
    }
  }

 private:
  Sample sample(double angle) const {
    const PlaneLine line = lines_(std::cos(angle), std::sin(angle));
    const Vector3 curved = frame_.curves.cwiseProduct(line.q);
    const double a = line.q.dot(curved);
    const double b = line.p.dot(curved) + line.q.dot(frame_.linear) / 2;
    const double c = frame_.value(line.p);
    const double discriminant = b * b - a * c;
    Sample s{angle, discriminant >= 0, {}};
    if (!s.is_real) return s;
    const double root = std::sqrt(discriminant);
    // (-b + root) / a and (-b - root) / a, without cancellation.
    const double sum = b > 0 ? -b - root : -b + root;
    const double one = sum / a, other = sum == 0 ? one : c / sum;
    const double ts[] = {b > 0 ? other : one, b > 0 ? one : other};
    for (int k = 0; k < 2; ++k) {
      Sample::Branch& branch = s.branch[k];
      branch.point = line.p + ts[k] * line.q;
      const Vector3& y = branch.point;
      branch.normal = frame_.gradient(y).normalized();
      const Vector3 tangent = branch.normal.cross(line.m), to_source = frame_.source - y;
      const double above = to_source.dot(branch.normal), eye_above = -y.dot(branch.normal);
      branch.law = to_source.dot(tangent) * eye_above - y.dot(tangent) * above;
      branch.is_same_side = above * eye_above > 0;
      if (!std::isfinite(branch.law)) s.is_real = false;
    }
    return s;
  }

  bool is_smooth(const Sample::Branch& a, const Sample::Branch& b) const {
    const auto alike = [&](const Vector3& end) {
      const Vector3 u = a.point - end, v = b.point - end;
      const double cosine = u.dot(v);
      return cosine > 0 && cosine * cosine > smooth * smooth * u.squaredNorm() * v.squaredNorm();
    };
    return a.normal.dot(b.normal) > smooth && alike(Vector3::Zero()) && alike(frame_.source);
  }

  bool is_far(const Sample::Branch& a) const { return !(a.point.norm() < far * frame_.size); }

  void between(const Sample& a, const Sample& b, int halves) {
    if (!a.is_real && !b.is_real) return;
    // Nodes are the ends of the curve; rounding may move them.
    const bool is_end = a.is_real != b.is_real;
    const auto is_rough = [&](int k) {
      return !is_smooth(a.branch[k], b.branch[k]) && !(is_far(a.branch[k]) && is_far(b.branch[k]));
    };
    const int most = is_end ? halves_at_end : most_halves;
    if ((is_end || is_rough(0) || is_rough(1)) && halves < most && splits_++ < most_splits) {
      const Sample middle = sample((a.angle + b.angle) / 2);
      between(a, middle, halves + 1);
      between(middle, b, halves + 1);
      return;
    }
    curve_.push_back(a);
  }

  bool is_sign_change(const Sample& a, const Sample& b, int k) const {
    return a.is_real && b.is_real && (a.branch[k].law < 0) != (b.branch[k].law < 0) &&
           !(is_far(a.branch[k]) && is_far(b.branch[k]));
  }

  void find_roots(int k) {
    for (std::size_t i = 0; i + 1 < curve_.size(); ++i) {
      if (is_sign_change(curve_[i], curve_[i + 1], k)) root(curve_[i], curve_[i + 1], k);
      if (i > 0 && is_dip(curve_[i - 1], curve_[i], curve_[i + 1], k))
        find_pair(curve_[i - 1], curve_[i], curve_[i + 1], k);
    }
  }

  // Whether the middle one of three samples is the nearest to a root, all of one sign.
  static bool is_dip(const Sample& a, const Sample& b, const Sample& c, int k) {
    if (!a.is_real || !b.is_real || !c.is_real) return false;
    const double sign = b.branch[k].law < 0 ? -1 : 1, y = sign * b.branch[k].law;
    return sign * a.branch[k].law > y && sign * c.branch[k].law > y;
  }

  // Two roots between three samples of one sign, by the parabolas through them.
  void find_pair(Sample a, Sample b, Sample c, int k) {
    constexpr int most_steps = 6;
    for (int step = 0; step < most_steps; ++step) {
      const double y = b.branch[k].law, sign = y < 0 ? -1 : 1;
      const double left = sign * (a.branch[k].law - y), right = sign * (c.branch[k].law - y);
      const double h = a.angle - b.angle, l = c.angle - b.angle;
      // y + slope d + bend d^2, d from b.
      const double bend = (left / h - right / l) / (h - l), slope = left / h - bend * h;
      const double lowest = sign * y - slope * slope / (4 * bend);
      if (!(bend > 0) || lowest > no_root_above * sign * y) return;
      const Sample next = sample(b.angle - slope / (2 * bend));
      if (!next.is_real || next.angle == b.angle) return;
      if ((next.branch[k].law < 0) != (y < 0)) {
        root(next.angle < b.angle ? a : b, next, k);
        root(next, next.angle < b.angle ? b : c, k);
        return;
      }
      // The lower of the two in the middle.
      const bool is_lower = sign * next.branch[k].law < sign * y;
      if (next.angle < b.angle)
        (is_lower ? c : a) = is_lower ? b : next;
      else
        (is_lower ? a : c) = is_lower ? b : next;
      if (is_lower) b = next;
      if (!is_dip(a, b, c, k)) return;
    }
  }

  // Regula falsi (the Illinois variant), then Newton's steps on the surface.
  void root(Sample a, Sample b, int k) {
    double at_a = a.branch[k].law, at_b = b.branch[k].law;
    int side = 0;
    for (int step = 0; step < 60; ++step) {
      const double apart = (a.branch[k].point - b.branch[k].point).norm();
      const bool is_same_side = a.branch[k].is_same_side || b.branch[k].is_same_side;
      // The law's sign changes, too, where its angles add up to half a turn.
      if (!is_same_side && apart < newton_from * frame_.size) return;
      const double share = at_a / (at_a - at_b);
      if (is_same_side && (step > 1 || apart < newton_from * frame_.size)) {
        const Vector3 guess = a.branch[k].point + share * (b.branch[k].point - a.branch[k].point);
        if (settle(guess, apart)) return;
      }
      const Sample next = sample(a.angle + share * (b.angle - a.angle));
      if (!next.is_real || next.angle == a.angle || next.angle == b.angle) return;
      const double at_next = next.branch[k].law;
      if ((at_next < 0) == (at_a < 0)) {
        a = next;
        at_a = at_next;
        if (side == 1) at_b /= 2;
        side = 1;
      } else {
        b = next;
        at_b = at_next;
        if (side == 2) at_a /= 2;
        side = 2;
      }
    }
  }

  // Whether light is reflected within `apart` of the guess.
  bool settle(const Vector3& guess, double apart) {
    const double reach = apart + 1e-9 * frame_.size;
    const auto near = [&](const Vector3& y, SurfacePoint& at) {
      return frame_(y, at) && (at.position - guess).norm() <= reach;
    };
    SurfacePoint at;
    if (!converges(path_, near, guess, apart, at)) return false;
    found_.push_back(at);
    return true;
  }

  const Frame& frame_;
  LightPath path_;
  const Lines& lines_;
  std::vector<SurfacePoint>& found_;
  std::vector<Sample> curve_;  // between two nodes
  int splits_ = 0;
};

// Where A cos^2 + 2 B cos sin + C sin^2 is 0.
void add_zeros(double a, double b, double c, std::vector<double>& angles) {
  const double middle = (a + c) / 2, swing = std::hypot((a - c) / 2, b);
  if (!(std::abs(middle) < swing)) return;
  const double phase = std::atan2(b, (a - c) / 2), half = std::acos(-middle / swing);
  angles.push_back((phase + half) / 2);
  angles.push_back((phase - half) / 2);
}

// The planes through both ends, whose line is along `ends`.
void search_planes(const Frame& f, const Vector3& ends, std::vector<SurfacePoint>& found) {
  const auto across = orthogonal_to(ends);
  const Vector3 m1 = across.col(0), m2 = across.col(1);
  const auto line = [&](double c, double s) -> PlaneLine {
    const Vector3 m = c * m1 + s * m2, k = 2 * f.curves.cwiseProduct(m), q = m.cross(k);
    const double length = q.norm();
    return {-f.linear.dot(m) / (length * length) * q.cross(m), q / length, m};
  };
  // Where the line touches the quadric, the curve turns back. With its direction q and its moment
  // r = p x q the discriminant is -r . cof(A) r + A q . (b x r) + (b . q)^2 / 4 - c q . A q, of the
  // fourth degree in the cosine and the sine: five values determine it.
  const Vector3 &a = f.curves, &b = f.linear;
  const Vector3 cofactors(a.y() * a.z(), a.z() * a.x(), a.x() * a.y());
  TurnPolynomial discriminant{0, 0, 0, 0, 0};  // of twice the angle
  for (int k = 0; k < 5; ++k) {
    const double angle = 2 * pi * k / 5;
    const Vector3 m = std::cos(angle / 2) * m1 + std::sin(angle / 2) * m2;
    const Vector3 q = m.cross(2 * a.cwiseProduct(m)), r = -b.dot(m) * m, curved = a.cwiseProduct(q);
    const double value = -r.dot(cofactors.cwiseProduct(r)) + curved.dot(b.cross(r)) +
                         b.dot(q) * b.dot(q) / 4 - f.constant * q.dot(curved);
    discriminant.constant += value / 5;
    discriminant.c1 += 2 * value / 5 * std::cos(angle);
    discriminant.s1 += 2 * value / 5 * std::sin(angle);
    discriminant.c2 += 2 * value / 5 * std::cos(2 * angle);
    discriminant.s2 += 2 * value / 5 * std::sin(2 * angle);
  }
  std::vector<double> nodes;
  for (const double angle : discriminant.zeros()) nodes.push_back(angle / 2);
  // Planes across or along an axis, near which the points may move fast.
  for (int i = 0; i < 3; ++i) {
    const double c = m1[i], s = m2[i];
    if (c * c + s * s < degenerate) continue;
    nodes.push_back(std::atan2(s, c));
    nodes.push_back(std::atan2(c, -s));
  }
  Search(f, line, found).run(std::move(nodes));
}

// The conic in a plane that mirrors the quadric.
void search_conic(const Frame& f, const Vector3& m, std::vector<SurfacePoint>& found) {
  const auto within = orthogonal_to(m);
  const Vector3 w1 = within.col(0), w2 = within.col(1);
  const auto line = [&](double c, double s) -> PlaneLine {
    return {Vector3::Zero(), c * w1 + s * w2, m};
  };
  // Lines through the eye that touch it: (b . w)^2 = 4 c w . A w.
  const auto form = [&](const Vector3& u, const Vector3& v) {
    return f.linear.dot(u) * f.linear.dot(v) - 4 * f.constant * u.dot(f.curves.cwiseProduct(v));
  };
  std::vector<double> nodes;
  add_zeros(form(w1, w1), form(w1, w2), form(w2, w2), nodes);
  Search(f, line, found).run(std::move(nodes));
}

// Normals of planes through both ends that mirror the quadric; of those that differ by a turn of
// the quadric into itself the first.
std::vector<Vector3> mirroring_planes(const Frame& f, const Vector3& ends) {
  std::vector<Vector3> planes;
  const double slope = degenerate * (f.linear.norm() + f.greatest * f.size);
  const auto add = [&](const Vector3& across) {
    const double length = across.norm();
    if (!(length > degenerate)) return;
    const Vector3 m = across / length, curved = f.curves.cwiseProduct(m);
    if (std::abs(m.dot(ends)) > degenerate || std::abs(f.linear.dot(m)) > slope ||
        m.cross(curved).norm() > degenerate * f.greatest)
      return;
    for (const Vector3& other : planes)
      if (std::abs(m.dot(curved) - other.dot(f.curves.cwiseProduct(other))) <=
          degenerate * f.greatest)
        return;
    planes.push_back(m);
  };
  if (!f.linear.isZero(0)) add(ends.cross(f.linear.normalized()));
  for (int i = 0; i < 3; ++i) {
    add(Vector3::Unit(i));
    add(ends.cross(Vector3::Unit(i)));
  }
  return planes;
}

}  // namespace

QuadricReflection::QuadricReflection(const Quadric& quadric, const Vector3& eye) : eye_(eye) {
  const SymmetricEigen<3> eigen = eigen_of(quadric.matrix());
  axes_ = eigen.vectors;
  curves_ = eigen.values;
  linear_ = axes_.transpose() * quadric.gradient(eye);
  constant_ = quadric.value(eye);
}

std::vector<SurfacePoint> QuadricReflection::operator()(const Vector3& source) const {
  const Frame frame{curves_, linear_, constant_, axes_.transpose() * (source - eye_)};
  // Where the ends coincide a plane through any line through them does.
  const double apart = frame.source.norm();
  const Vector3 ends =
      apart > degenerate * frame.size ? Vector3(frame.source / apart) : Vector3(2, 3, 6) / 7;
  std::vector<SurfacePoint> found;
  for (const Vector3& m : mirroring_planes(frame, ends)) search_conic(frame, m, found);
  search_planes(frame, ends, found);
  for (SurfacePoint& at : found) {
    at.position = eye_ + axes_ * at.position;
    at.normal = axes_ * at.normal;
    at.shape = axes_ * at.shape * axes_.transpose();
  }
  return found;
}

}  // namespace symsurf
