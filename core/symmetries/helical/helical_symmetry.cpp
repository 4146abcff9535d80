#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "analysis.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/nelder_mead.h"
#include "base/parallel.h"
#include "cloud/surfels.h"
#include "fit/shapes.h"
#include "sampled_shape.h"
#include "score/mirror_score.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

// The screw motions about an axis. Winding: radians by which a slide of 1 turns.
struct Helix {
  Vector3 point = Vector3::Zero(), axis = Vector3::UnitZ();  // unit
  double winding = 0;

  double along(const Vector3& x) const { return axis.dot(x - point); }

  Eigen::Isometry3d motion(double slide) const {
    return map_taking(turn_by(winding * slide * axis), point, point + slide * axis);
  }

  // Two tilts and two shifts across the axis, and what is added to the winding.
  using Change = Eigen::Vector<double, 5>;
  Helix changed(const Change& by) const {
    Helix next = *this;
    for (int k = 0; k < 2; ++k) {
      next.axis += by[k] * across(axis, k);
      next.point += by[2 + k] * across(axis, k);
    }
    next.axis.normalize();
    next.winding += by[4];
    return next;
  }
  Helix with_winding(double other) const { return {point, axis, other}; }
};

// Screw velocities that slide a shape along itself: the linear complexes nearest to its normals
// (Pottmann and Randrup 1998; Gelfand and Guibas 2004). Where surfels lie across a thin wire, all
// directions across it are normals.
class Slippage {
 public:
  explicit Slippage(const Surfels& surfels) {
    constexpr double thin = 0.02;  // of a surfel's variance
    for (Index i = 0; i < surfels.size(); ++i) {
      const double noise = thin * surfels[i].covariance.trace();
      if (!(noise > 0)) continue;
      const Matrix3 normals =
          noise * (surfels[i].covariance + noise * Matrix3::Identity()).inverse();
      Eigen::Matrix<double, 3, 6> velocity;  // by the turn and the shift
      velocity << -cross_matrix(surfels[i].position), Matrix3::Identity();
      off_.emplace_back(velocity.transpose() * normals * velocity);
      all_.emplace_back(velocity.transpose() * velocity);
    }
  }

  // Of the velocity with the k-th least share off the surface. Ends and heads, which it takes off
  // themselves, weigh less from round to round.
  Helix axis(int k) const {
    constexpr int rounds = 12;
    constexpr double agreeing = 2;  // median shares
    std::vector<double> weights(off_.size(), 1);
    Eigen::VectorXd velocity;
    for (int round = 0; round < rounds; ++round) {
      Eigen::MatrixXd off = Eigen::MatrixXd::Zero(6, 6), all = off;
      for (std::size_t i = 0; i < off_.size(); ++i) {
        off += weights[i] * off_[i];
        all += weights[i] * all_[i];
      }
      all.diagonal().array() += double_rounding * (1 + all.trace());
      const Eigen::MatrixXd velocities = eigen_of(off, all).vectors;
      Index same = k;
      if (round > 0) (velocities.transpose() * all * velocity).cwiseAbs().maxCoeff(&same);
      velocity = velocities.col(same);
      std::vector<double> shares;
      for (std::size_t i = 0; i < off_.size(); ++i)
        shares.push_back(velocity.dot(off_[i] * velocity) /
                         std::max(velocity.dot(all_[i] * velocity), double_rounding));
      if (shares.empty()) break;
      const double scale = agreeing * std::max(median(shares), single_rounding);
      for (std::size_t i = 0; i < off_.size(); ++i)
        weights[i] = 1 / (1 + shares[i] * shares[i] / (scale * scale));
    }
    const Vector3 turn = velocity.head<3>(), shift = velocity.tail<3>();
    const Vector3 point = turn.cross(shift) / turn.squaredNorm();
    // A shift hardly turns.
    if (!(point.squaredNorm() < 1)) return {Vector3::Zero(), shift.stableNormalized()};
    return {point, turn.normalized()};
  }

 private:
  std::vector<Eigen::Matrix<double, 6, 6>> off_, all_;
};

// Points turned back about an axis in step with where they lie along it: those of a helical surface
// fall onto its cross section, and concentrate.
class UnscrewedPoints {
 public:
  explicit UnscrewedPoints(const Surfels& surfels) {
    for (Index i = 0; i < surfels.size(); ++i) points_.push_back(surfels[i].sampled);
  }

  const std::vector<Vector3>& points() const { return points_; }

  // Those of a stretch of the axis, as heads and shanks hide the winding of a thread.
  UnscrewedPoints between(const Helix& helix, double low, double high) const {
    UnscrewedPoints some = *this;
    std::erase_if(some.points_,
                  [&](const Vector3& x) { return helix.along(x) < low || helix.along(x) > high; });
    return some;
  }

  // The same axis with its point in the middle of them.
  Helix centred(const Helix& helix) const {
    const auto [low, high] = std::minmax_element(
        points_.begin(), points_.end(),
        [&](const Vector3& a, const Vector3& b) { return helix.axis.dot(a - b) < 0; });
    return {helix.point + (helix.along(*low) + helix.along(*high)) / 2 * helix.axis, helix.axis,
            helix.winding};
  }

  // Along the axis, from its point.
  double half_length(const Helix& helix) const {
    double most = 0;
    for (const Vector3& x : points_) most = std::max(most, std::abs(helix.along(x)));
    return most;
  }

  // Of most of them about the axis.
  double radius(const Helix& helix) const {
    std::vector<double> radii;
    for (const Vector3& x : points_) radii.push_back(helix.axis.cross(x - helix.point).norm());
    return quantile(std::move(radii), 0.9);
  }

  // The windings at which they concentrate most, beside those around.
  std::vector<double> peaks(const Helix& axis, double width, const Context& context) const {
    constexpr double shortest = 3;  // widths a turn
    constexpr double most = 4096;   // steps: a second
    constexpr double around = 2;    // turns over the length, farther than a peak is wide
    constexpr std::size_t tried = 6;
    const double step = this->step(axis, width);
    if (!(step < infinity)) return {};
    const auto last =
        static_cast<Index>(std::min(2 * std::numbers::pi / (shortest * width * step), most));
    std::vector<double> found(2 * last + 1);
    parallel_for(context, 2 * last + 1, 64, [&](Index begin, Index end) {
      context.check();
      Section now = section(axis.with_winding(static_cast<double>(begin - last) * step)), by = now;
      for (std::size_t i = 0; i < now.size(); ++i)
        by[i] = std::polar(1.0, -step * axis.along(points_[i]));
      for (Index k = begin; k < end; ++k) {
        found[k] = Cells(now, width).concentration();
        for (std::size_t i = 0; i < now.size(); ++i) now[i] *= by[i];
      }
    });
    const auto reach =
        std::min(last, static_cast<Index>(around * std::numbers::pi / (half_length(axis) * step)));
    std::vector<std::pair<double, Index>> best;  // contrast and where
    for (Index k = 1; k < 2 * last; ++k) {
      if (found[k] < std::max(found[k - 1], found[k + 1])) continue;
      const double background =
          median(std::vector<double>(found.begin() + std::max<Index>(0, k - reach),
                                     found.begin() + std::min(2 * last, k + reach) + 1));
      best.emplace_back(found[k] / background, k);
    }
    std::sort(best.begin(), best.end(), std::greater<>());
    suppress_non_maxima(best, tried, [&](const auto& a, const auto& b) {
      return std::abs(a.second - b.second) < reach / 2;
    });
    std::vector<double> windings;
    for (const auto& [contrast, k] : best) windings.push_back(static_cast<double>(k - last) * step);
    return windings;
  }

  // The helix nearby at which they concentrate most.
  Helix most_concentrated(const Helix& start, double width) const {
    const double half = half_length(start);
    Helix::Change scale;
    scale << 1 / half, 1 / half, 1, 1, step(start, width) / width;
    const auto changed = [&](const Helix::Change& by) {
      return start.changed(by.cwiseProduct(scale));
    };
    int evaluations = 400;
    return changed(nelder_mead<5>(
        [&](const Helix::Change& by) { return Cells(section(changed(by)), width).concentration(); },
        Helix::Change(Helix::Change::Zero()), width, width / 100, evaluations));
  }

  // The density of the others at each of them.
  std::vector<double> densities(const Helix& helix, double width) const {
    const Section all = section(helix);
    const Cells cells(all, width);
    std::vector<double> found;
    for (const std::complex<double>& x : all) found.push_back(cells.density_beside(x));
    return found;
  }

 private:
  using Section = std::vector<std::complex<double>>;

  // Square cells of a section. Each point is shared by the four whose middles are around it.
  class Cells {
   public:
    Cells(const Section& section, double width) : width_(width) {
      for (const std::complex<double>& x : section)
        reach_ = std::max({reach_, std::abs(x.real()), std::abs(x.imag())});
      side_ = static_cast<Index>(2 * reach_ / width) + 2;
      counts_.assign(side_ * side_, 0);
      for (const std::complex<double>& x : section)
        visit(x, [&](Index cell, double share) { counts_[cell] += share; });
    }

    double concentration() const {
      double squares = 0;
      for (const double count : counts_) squares += count * count;
      return squares;
    }

    double density_beside(const std::complex<double>& x) const {
      double density = 0;
      visit(x, [&](Index cell, double share) { density += share * (counts_[cell] - share); });
      return density;
    }

   private:
    template <typename Visit>
    void visit(const std::complex<double>& x, const Visit& take) const {
      const double a = (x.real() + reach_) / width_, b = (x.imag() + reach_) / width_;
      const auto i = static_cast<Index>(a), j = static_cast<Index>(b);
      const double s = a - static_cast<double>(i), t = b - static_cast<double>(j);
      const Index cell = i * side_ + j;
      take(cell, (1 - s) * (1 - t));
      take(cell + 1, (1 - s) * t);
      take(cell + side_, s * (1 - t));
      take(cell + side_ + 1, s * t);
    }

    double width_, reach_ = 0;
    Index side_;
    std::vector<double> counts_;
  };

  // Between windings: by it the ends move by a width against the middle.
  double step(const Helix& helix, double width) const {
    return width / (half_length(helix) * radius(helix));
  }

  Section section(const Helix& helix) const {
    const Vector3 u = across(helix.axis, 0), v = across(helix.axis, 1);
    Section all;
    all.reserve(points_.size());
    for (const Vector3& x : points_) {
      const Vector3 off = x - helix.point;
      all.push_back(std::polar(1.0, -helix.winding * helix.axis.dot(off)) *
                    std::complex(u.dot(off), v.dot(off)));
    }
    return all;
  }

  std::vector<Vector3> points_;
};

// A helix and the part of the shape, from `low` to `high` along the axis, that it describes.
struct Found {
  Helix helix;
  double low = 0, high = 0;
  double score = 0;     // share of the part that its screws map onto the shape
  double evidence = 0;  // share of the density, and of what exceeds it, beyond other windings

  double merit() const { return score * evidence; }
};

class HelixSearch {
 public:
  HelixSearch(const Cloud& cloud, const Context& context)
      : surfels_(fine(cloud, context.stage(0, 0.5))),
        score_(cloud, context.stage(0.5, 1)),
        points_(surfels_) {}

  // Slippage has the axis. Of bodies that slide along themselves in several ways it is another.
  Found best(double minimum_score, const Context& context) const {
    const Slippage slippage(surfels_);
    Found best;
    for (const int k : {0, 1})
      for (const double width : {surfels_.spacing(), surfels_.spacing() / 2}) {
        const auto improve = [&](const UnscrewedPoints& points, const Helix& axis, double wide) {
          for (const double winding : points.peaks(axis, wide, context.stage(0, 0))) {
            Helix helix = axis.with_winding(winding);
            for (const double narrower : {wide, wide / 2})
              helix = points_.centred(points.most_concentrated(helix, narrower));
            const Found found = judged(helix, width);
            if (found.merit() > best.merit()) best = found;
          }
        };
        improve(points_, points_.centred(slippage.axis(k)), width);
        if (best.score < minimum_score || best.evidence < least_evidence) continue;
        improve(points_.between(best.helix, best.low, best.high), best.helix, width / 2);
        return best;
      }
    return best;
  }

  static constexpr double least_evidence = 0.13;

 private:
  static const Surfels& fine(const Cloud& cloud, const Context& context) {
    const Index count = std::min<Index>(1000, cloud.points.size() / 2);
    cloud.patches(count, context.stage(0, 0.5));
    return cloud.finer_patches(count, context.stage(0.5, 1));
  }

  Found judged(const Helix& helix, double width) const {
    constexpr double least_twist = 0.125;  // turns over the length: less is a bent prism
    Found found{helix};
    const double half = points_.half_length(helix), turn = std::numbers::pi / half;
    if (std::abs(helix.winding) < least_twist * turn) return found;
    set_part(found, half, turn, width);
    if (found.evidence < least_evidence) return found;
    // What images reach at most is what they do next to the points.
    const double nearest = mapped_share(
        found, 2 * surfels_.spacing() / std::hypot(1, helix.winding * points_.radius(helix)));
    double sum = 0;
    for (const double share : {0.11, 0.23, 0.37})
      sum += mapped_share(found, share * (found.high - found.low)) / 3;
    if (nearest > 0) found.score = std::min(1.0, sum / nearest);
    return found;
  }

  // Of the samples that slides by about so much leave in the part. Those by more than half a turn
  // end with half of one, as rings stay on themselves by whole ones.
  double mapped_share(const Found& found, double slide) const {
    const double pitch = 2 * std::numbers::pi / std::abs(found.helix.winding);
    if (slide > pitch / 2) slide = (std::floor(slide / pitch) + 0.5) * pitch;
    double mapped = 0, all = 0;
    for (const double way : {slide, -slide})
      for (const PointFit& fit : score_.point_fits(found.helix.motion(way))) {
        const double onto = found.helix.along(fit.image), from = onto - way;
        if (std::min(from, onto) < found.low || std::max(from, onto) > found.high) continue;
        all += fit.weight - fit.missing;
        mapped += (fit.weight - fit.missing) * fit.mapped();
      }
    return all > 0 ? mapped / all : 0;
  }

  static constexpr int bins = 40;  // along the axis
  using Profile = Eigen::Array<double, bins, 1>;

  // Successive bins with the most beyond others together.
  struct Stretch {
    int from = 0, to = 0;
    double gain = 0;

    Stretch(const Profile& own, const Profile& others) {
      constexpr double clearly = 1.15;  // denser: beyond chance
      double sum = 0;
      for (int bin = 0, first = 0; bin < bins; ++bin) {
        if (!(sum > 0)) {
          sum = 0;
          first = bin;
        }
        sum += own[bin] - clearly * others[bin];
        if (sum > gain) *this = {first, bin + 1, sum};
      }
    }
    Stretch(int from, int to, double gain) : from(from), to(to), gain(gain) {}
    double of(const Profile& profile) const { return profile.segment(from, to - from).sum(); }
  };

  // Where along the axis points are denser than with other windings, with none among them, and by
  // how much.
  void set_part(Found& found, double half, double turn, double width) const {
    constexpr int others = 16;
    constexpr double least_points = 0.1, least_bins = 6;  // shares: ends look helical, too
    const auto profile = [&](const std::vector<double>& densities) {
      Profile sums = Profile::Zero();
      for (std::size_t i = 0; i < densities.size(); ++i) {
        const double at = (found.helix.along(points_.points()[i]) / half + 1) / 2;
        sums[std::clamp(static_cast<int>(at * bins), 0, bins - 1)] += densities[i];
      }
      return sums;
    };
    const auto profile_of = [&](double winding) {
      return profile(points_.densities(found.helix.with_winding(winding), width));
    };
    const double winding = found.helix.winding;
    std::vector<Profile> beside;
    Profile mean = Profile::Zero();
    for (int k = 0; k < others; ++k) {
      // Turns over the length, no two of which are in step.
      const double off = 1.37 * (k / 2 + 1.7) * (k % 2 ? 1 : -1);
      beside.push_back(profile_of(winding + off * turn));
      mean += beside.back() / others;
    }
    mean = mean.max(profile_of(0));
    const Profile own = profile_of(winding);
    const Stretch part(own, mean);
    const Profile count = profile(std::vector<double>(points_.points().size(), 1));
    if (part.of(count) < least_points * count.sum() || part.to - part.from < least_bins) return;
    double chance = 0;
    for (const Profile& other : beside) chance = std::max(chance, Stretch(other, mean).gain);
    found.low = half * (2.0 * part.from / bins - 1);
    found.high = half * (2.0 * part.to / bins - 1);
    found.evidence = std::max(0.0, 1 - std::max(part.of(mean) / part.of(own), chance / part.gain));
  }

  const Surfels& surfels_;
  MirrorScore score_;
  UnscrewedPoints points_;
};

// Empty: it is a helix.
std::string reason_against(const Found& found, double minimum_score) {
  const auto digits = [](double x) { return to_string(Value(std::floor(1e4 * x) / 1e4)); };
  if (found.evidence < HelixSearch::least_evidence)
    return "the evidence of the best helix is " + digits(found.evidence) + ", below " +
           to_string(Value(HelixSearch::least_evidence)) +
           ": other pitches, turns or translations fit nearly as well";
  if (found.score < minimum_score)
    return "the best helix scores " + digits(found.score) + ", below the minimum_score of " +
           to_string(Value(minimum_score));
  return {};
}

void run_helical_symmetry(const ColouredCloud& given, const ParameterValues& values,
                          const Context& context, AnalysisResult& result) {
  const double minimum_score = values.real("minimum_score");
  const SampledShape shape(given, context.stage(0, 0.2));
  const HelixSearch search(shape.cloud, context.stage(0.2, 0.5));
  const Found found = search.best(minimum_score, context.stage(0.5, 1));
  const std::string reason = reason_against(found, minimum_score);
  result.statistics = {{"verdict", std::string(reason.empty() ? "found" : "none")},
                       {"reason", reason},
                       {"score", found.score},
                       {"evidence", found.evidence}};
  Eigen::VectorXd helical = Eigen::VectorXd::Zero(given.points.size());
  if (reason.empty()) {
    const PrincipalFrame& frame = shape.cloud.frame;
    const Helix& helix = found.helix;
    // The frame may be left-handed.
    const Helix own{frame.from_frame(helix.point + (found.low + found.high) / 2 * helix.axis),
                    frame.axes * helix.axis, frame.axes.determinant() * helix.winding / frame.size};
    const double pitch = 2 * std::numbers::pi / std::abs(own.winding);
    const double length = (found.high - found.low) * frame.size;
    result.statistics["pitch"] = pitch;
    result.statistics["handedness"] = std::string(own.winding > 0 ? "right" : "left");
    result.statistics["length"] = length;
    result.axes.push_back({own.point, own.axis, 1});
    result.transformations.push_back(
        {"screw", own.motion(pitch / 4).matrix(), found.score, {}, {}});
    for (Index i = 0; i < given.points.size(); ++i)
      helical[i] = std::abs(own.along(given.points[i])) <= length / 2;
  }
  result.arrays = {{"helical", helical}};
}

}  // namespace

AnalysisImplementation helical_symmetry_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "helical_symmetry";
  analysis.title = "Helical symmetry";
  analysis.summary =
      "Finds the axis, pitch, handedness and extent of a spring, thread or drill: screw motions "
      "map it onto itself.";
  analysis.parameters = {
      Parameter::real("minimum_score", 0.85, 0, 1, "",
                      "Minimum score of a helix: share of the helical part that screw motions map "
                      "onto the shape.")};
  analysis.arrays = {{"helical", ParameterType::Boolean, 1,
                      "Whether the point lies between the ends of the helical part."}};
  analysis.shown = "helical";
  analysis.minimum_points = SampledShape::minimum_points;
  analysis.finds_elements = analysis.finds_transforms = true;
  analysis.run = run_helical_symmetry;
  return analysis;
}

}  // namespace symsurf
