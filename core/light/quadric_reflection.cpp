#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "reflection_search.h"

namespace symsurf {

namespace {

using std::numbers::pi;

constexpr int most_halves = 40;
constexpr int most_splits = 500;  // between two nodes: where rounding is all that moves, it ends
constexpr double smooth = 0.95;   // cosine between neighbouring samples' normals and views
constexpr double clear = 0.1;     // the least value against the greatest, where none is a root
constexpr double gap = 1e-11;     // of an interval, beside its nodes, where a plane may be singular
constexpr double degenerate = 1e-9;  // of the numbers that are compared
constexpr double at_apex = 1e-6;     // sizes: nearer to a cone's apex the normal is rounding

// In the frame of a quadric's axes about the eye: its numbers, and the source.
struct Frame {
  Vector3 curves, linear;
  double constant;
  Vector3 source;
  double greatest = curves.cwiseAbs().maxCoeff();
  double size = source.norm() + extent();

  Vector3 gradient(const Vector3& y) const { return 2 * curves.cwiseProduct(y) + linear; }
  double value(const Vector3& y) const { return y.dot(curves.cwiseProduct(y) + linear) + constant; }
  Vector3 centre() const { return -linear.cwiseQuotient(2 * curves); }
  // How far the quadric is, and how large.
  double extent() const {
    const double slope = linear.norm();
    return (greatest > 0 ? slope / greatest + std::sqrt(std::abs(constant) / greatest) : 0) +
           (slope > 0 ? std::abs(constant) / slope : 0);
  }

  // The quadric's point next to y; none far from any.
  std::optional<SurfacePoint> operator()(Vector3 y) const {
    for (int k = 0; k < 3; ++k) {
      const Vector3 g = gradient(y);
      y -= value(y) / g.squaredNorm() * g;
    }
    const Vector3 g = gradient(y);
    const double length = g.norm();
    const Vector3 normal = g / length;
    if (!normal.allFinite() || !(length > at_apex * greatest * size)) return std::nullopt;
    const Matrix3 tangent = Matrix3::Identity() - normal * normal.transpose();
    return SurfacePoint{y, normal, tangent * (2 / length * curves).asDiagonal() * tangent};
  }
};

// A line p + t q in a plane with the normal m. It is in a pencil of planes through the eye, with
// the normal `across`, whose derivative by the angle is `turn`.
struct PlaneLine {
  Vector3 p, q, m, across, turn;
};

// One of the two points of the quadric on such a line, and how far it is from the law of
// reflection.
struct Sample {
  double at;
  bool is_real;
  Vector3 point, normal, to_source, to_eye;  // all but the first of length 1
  double law, slope;                         // its derivative by `at`
  bool is_same_side;                         // of the tangent plane: are both ends, near a root?
};

// Searches the points of a family of lines, by an angle.
template <typename Lines>
class Search {
 public:
  Search(const Frame& frame, const Lines& lines, std::vector<SurfacePoint>& found)
      : frame_(frame), path_{frame.source, Vector3::Zero()}, lines_(lines), found_(found) {}

  // Over half a turn; nodes: angles at which the curve begins, ends, is singular or far.
  void run(std::vector<double> nodes) {
    for (double& node : nodes) node -= pi * std::floor(node / pi);
    std::sort(nodes.begin(), nodes.end());
    if (nodes.empty()) nodes.push_back(0);
    nodes.push_back(nodes.front() + pi);
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      node_ = nodes[k];
      width_ = nodes[k + 1] - node_;
      if (width_ < degenerate) continue;
      const double near = std::sqrt(gap / 3);
      const Crossing first = cross(near), half = cross(0.5), last = cross(1 - near);
      std::array<Sample, 2> begins, ends;
      for (branch_ = 0; branch_ < 2; ++branch_) {
        splits_ = 0;
        const Sample middle = sample(half);
        between(begins[branch_] = sample(first), middle, 0);
        between(middle, ends[branch_] = sample(last), 0);
      }
      turn_back(begins);
      turn_back(ends);
    }
  }

 private:
  // A line, and where on it both branches are.
  struct Crossing {
    double at;
    PlaneLine line;
    bool is_real;
    std::array<double, 2> t;
  };

  // Both branches are one where the line touches the quadric.
  void turn_back(const std::array<Sample, 2>& s) {
    if (s[0].is_real && s[1].is_real && is_smooth(s[0], s[1]) && (s[0].law < 0) != (s[1].law < 0))
      settle((s[0].point + s[1].point) / 2, (s[0].point - s[1].point).norm());
  }

  // Between two nodes by a number of 0 to 1: at a node the points move as the root of the plane's
  // angle, and so evenly.
  Crossing cross(double at) const {
    const double angle = node_ + width_ * at * at * (3 - 2 * at);
    const PlaneLine line = lines_(std::cos(angle), std::sin(angle));
    const Vector3 curved = frame_.curves.cwiseProduct(line.q);
    const double a = line.q.dot(curved);
    const double b = line.p.dot(curved) + line.q.dot(frame_.linear) / 2;
    const double c = frame_.value(line.p);
    const double discriminant = b * b - a * c;
    // (-b + root) / a and (-b - root) / a, without cancellation.
    const double root = std::sqrt(discriminant), sum = b > 0 ? -b - root : -b + root;
    const double one = sum / a, other = sum == 0 ? one : c / sum;
    return {at, line, discriminant >= 0, {b > 0 ? other : one, b > 0 ? one : other}};
  }

  Sample sample(double at) const { return sample(cross(at)); }

  Sample sample(const Crossing& crossing) const {
    Sample s;
    s.at = crossing.at;
    s.is_real = crossing.is_real;
    if (!s.is_real) return s;
    s.point = crossing.line.p + crossing.t[branch_] * crossing.line.q;
    apply_law(crossing.line, s);
    return s;
  }

  // The law is the sine of the sum of the angles of both ends with the normal, about m.
  void apply_law(const PlaneLine& line, Sample& s) const {
    const Vector3 n = frame_.gradient(s.point), along = lines_.tangent(s.point, n);
    const double speed = 6 * width_ * s.at * (1 - s.at);
    const Vector3 move = -speed * line.turn.dot(s.point) / line.across.dot(along) * along;
    const Vector3 source = frame_.source - s.point, eye = -s.point;
    s.normal = n.normalized();
    s.to_source = source.normalized();
    s.to_eye = eye.normalized();
    const Vector3 tangent = s.normal.cross(line.m);
    const double s1 = s.to_source.dot(tangent), s2 = s.to_eye.dot(tangent);
    const double c1 = s.to_source.dot(s.normal), c2 = s.to_eye.dot(s.normal);
    s.law = s1 * c2 + s2 * c1;
    const double cosine = c1 * c2 - s1 * s2;
    s.is_same_side = cosine > 0;
    const auto spin = [&](const Vector3& v, const Vector3& change) {
      return line.m.dot(v.cross(change)) / v.squaredNorm();
    };
    const Vector3 bend = 2 * frame_.curves.cwiseProduct(move);
    s.slope = cosine * (2 * spin(n, bend) - spin(source, -move) - spin(eye, -move));
    s.is_real = std::isfinite(s.law) && std::isfinite(s.slope);
  }

  static bool is_smooth(const Sample& a, const Sample& b) {
    return a.normal.dot(b.normal) > smooth && a.to_source.dot(b.to_source) > smooth &&
           a.to_eye.dot(b.to_eye) > smooth;
  }

  // Whether the cubic of both values and slopes rises or falls throughout, or stays away from 0: by
  // its Bernstein coefficients.
  static bool is_clear(const Sample& a, const Sample& b) {
    const double third = (b.at - a.at) / 3, sign = a.law < 0 ? -1 : 1;
    const Eigen::Vector4d c =
        sign * Eigen::Vector4d(a.law, a.law + third * a.slope, b.law - third * b.slope, b.law);
    const Eigen::Vector3d rise = c.tail<3>() - c.head<3>();
    return rise.minCoeff() > 0 || rise.maxCoeff() < 0 || c.minCoeff() > clear * c.maxCoeff();
  }

  void between(const Sample& a, const Sample& b, int halves) {
    if (!a.is_real && !b.is_real) return;
    // Nodes are the ends of the curve; rounding may move them.
    const bool is_end = a.is_real != b.is_real;
    if ((is_end || !is_smooth(a, b) || !is_clear(a, b)) && halves < most_halves &&
        splits_++ < most_splits) {
      const Sample middle = sample((a.at + b.at) / 2);
      between(a, middle, halves + 1);
      between(middle, b, halves + 1);
    } else if (!is_end && (a.law < 0) != (b.law < 0) && (a.is_same_side || b.is_same_side)) {
      root(a, b);
    }
  }

  // Halves, until Newton's steps on the surface lead to it.
  void root(Sample a, Sample b) {
    for (int step = 0; step < 60; ++step) {
      const double share = a.law / (a.law - b.law);
      if (settle(a.point + share * (b.point - a.point), (a.point - b.point).norm())) return;
      const Sample next = sample((a.at + b.at) / 2);
      if (!next.is_real || next.at == a.at || next.at == b.at) return;
      ((next.law < 0) == (a.law < 0) ? a : b) = next;
    }
  }

  // Whether light is reflected within `apart` of the guess.
  bool settle(const Vector3& guess, double apart) {
    const auto near = [&](const Vector3& y) {
      std::optional<SurfacePoint> at = frame_(y);
      if (at && !((at->position - guess).norm() <= apart + 1e-9 * frame_.size)) at.reset();
      return at;
    };
    const std::optional<SurfacePoint> at = converged(path_, near, guess, apart);
    if (at) found_.push_back(*at);
    return at.has_value();
  }

  const Frame& frame_;
  LightPath path_;
  const Lines& lines_;
  std::vector<SurfacePoint>& found_;
  double node_ = 0, width_ = pi;  // of the interval that is searched, radians
  int branch_ = 0;
  int splits_ = 0;
};

// The planes through both ends, whose line is along `ends`.
struct Planes {
  const Frame& f;
  Vector3 ends, m1, m2;

  PlaneLine operator()(double c, double s) const {
    const Vector3 m = c * m1 + s * m2, q = m.cross(2 * f.curves.cwiseProduct(m));
    const double length = q.norm();
    return {-f.linear.dot(m) / (length * length) * q.cross(m), q / length, m, m, c * m2 - s * m1};
  }
  // Across the gradients of both quadrics, the second being n . (y x ends).
  Vector3 tangent(const Vector3& y, const Vector3& n) const {
    return n.cross(2 * f.curves.cwiseProduct(y.cross(ends)) + ends.cross(n));
  }
};

// The lines through the eye in a plane with the normal m that mirrors the quadric.
struct PlaneOfLines {
  Vector3 m, w1, w2;

  PlaneLine operator()(double c, double s) const {
    const Vector3 w = c * w1 + s * w2;
    return {Vector3::Zero(), w, m, c * w2 - s * w1, -w};
  }
  Vector3 tangent(const Vector3&, const Vector3& n) const { return n.cross(m); }
};

// The zeros of a form of the second or fourth degree in the cosine and the sine: five values
// determine it.
template <typename Form>
void add_zeros(const Form& form, std::vector<double>& angles) {
  TurnPolynomial p{0, 0, 0};  // of twice the angle
  for (int k = 0; k < 5; ++k) {
    const double angle = 2 * pi * k / 5;
    const double value = form(std::cos(angle / 2), std::sin(angle / 2)) / 5;
    p.constant += value;
    p.one += 2 * value * std::polar(1.0, angle);
    p.two += 2 * value * std::polar(1.0, 2 * angle);
  }
  for (const double angle : p.zeros()) angles.push_back(angle / 2);
}

void search_planes(const Frame& f, const Vector3& ends, std::vector<SurfacePoint>& found) {
  const auto basis = orthogonal_to(ends);
  const Planes planes{f, ends, basis.col(0), basis.col(1)};
  const Vector3 &a = f.curves, &b = f.linear, &m1 = planes.m1, &m2 = planes.m2;
  const auto direction = [&](double c, double s) -> std::pair<Vector3, Vector3> {
    const Vector3 m = c * m1 + s * m2;
    return {m, m.cross(2 * a.cwiseProduct(m))};
  };
  std::vector<double> nodes;
  // Where the line touches the quadric, the curve turns back. With its direction q and its moment
  // r = p x q the discriminant is -r . cof(A) r + A q . (b x r) + (b . q)^2 / 4 - c q . A q.
  const Vector3 cofactors(a.y() * a.z(), a.z() * a.x(), a.x() * a.y());
  const auto discriminant = [&](double c, double s) {
    const auto [m, q] = direction(c, s);
    const Vector3 r = -b.dot(m) * m, curved = a.cwiseProduct(q);
    return -r.dot(cofactors.cwiseProduct(r)) + curved.dot(b.cross(r)) + b.dot(q) * b.dot(q) / 4 -
           f.constant * q.dot(curved);
  };
  add_zeros(discriminant, nodes);
  // Where it is along the quadric's asymptotes, a point is infinitely far.
  const auto asymptote = [&](double c, double s) {
    const Vector3 q = direction(c, s).second;
    return q.dot(a.cwiseProduct(q));
  };
  add_zeros(asymptote, nodes);
  // Planes across or along an axis, near which the points may move fast, and through the centre,
  // where a cone has its apex.
  for (int i = 0; i < 3; ++i) {
    const double c = m1[i], s = m2[i];
    if (c * c + s * s < degenerate) continue;
    nodes.push_back(std::atan2(s, c));
    nodes.push_back(std::atan2(c, -s));
  }
  const Vector3 centre = f.centre();
  if (centre.allFinite()) nodes.push_back(std::atan2(-m1.dot(centre), m2.dot(centre)));
  Search(f, planes, found).run(std::move(nodes));
}

// The conic in a plane that mirrors the quadric.
void search_conic(const Frame& f, const Vector3& m, std::vector<SurfacePoint>& found) {
  const auto within = orthogonal_to(m);
  const PlaneOfLines lines{m, within.col(0), within.col(1)};
  const Vector3 &w1 = lines.w1, &w2 = lines.w2;
  // Lines through the eye that touch it: (b . w)^2 = 4 c w . A w; asymptotes: w . A w = 0.
  const auto curved = [&](double c, double s) {
    const Vector3 w = c * w1 + s * w2;
    return w.dot(f.curves.cwiseProduct(w));
  };
  const auto discriminant = [&](double c, double s) {
    const double slope = f.linear.dot(c * w1 + s * w2);
    return slope * slope - 4 * f.constant * curved(c, s);
  };
  std::vector<double> nodes;
  add_zeros(discriminant, nodes);
  add_zeros(curved, nodes);
  const Vector3 centre = f.centre();
  if (centre.allFinite()) nodes.push_back(std::atan2(w2.dot(centre), w1.dot(centre)));
  Search(f, lines, found).run(std::move(nodes));
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

ReflectionFinder quadric_reflection(const Quadric& quadric, const Vector3& eye) {
  const auto [values, axes] = eigen_of(quadric.matrix());
  constexpr double rounding = 1e-14;
  const Vector3 curves =
      (values.array().abs() > rounding * values.cwiseAbs().maxCoeff()).select(values, 0);
  return [curves, axes = axes, linear = Vector3(axes.transpose() * quadric.gradient(eye)),
          constant = quadric.value(eye)](const LightPath& path) {
    const Frame frame{curves, linear, constant, axes.transpose() * (path.source - path.eye)};
    // Where the ends coincide a plane through any line through them does.
    const double apart = frame.source.norm();
    const Vector3 ends =
        apart > degenerate * frame.size ? Vector3(frame.source / apart) : Vector3(2, 3, 6) / 7;
    std::vector<SurfacePoint> found;
    for (const Vector3& m : mirroring_planes(frame, ends)) search_conic(frame, m, found);
    search_planes(frame, ends, found);
    for (SurfacePoint& at : found)
      at = {path.eye + axes * at.position, axes * at.normal, axes * at.shape * axes.transpose()};
    return found;
  };
}

}  // namespace symsurf
