#include "preprocess/volumetric.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/quantile.h"
#include "base/rows_of.h"
#include "base/symmetric_eigen.h"
#include "cloud/surroundings.h"
#include "spatial/point_hash.h"

namespace symsurf {

namespace {

// A sample of the points decides whether a cloud is volumetric: first a few, as most are not. The
// squared thickness over the squared length of what is around a point is .3 to .35 within bodies,
// in the median, and less where there are surfaces, unless noise as large as their points' spacing
// blurs them.
struct Effort {
  Index chosen, asked;
};
constexpr Effort rough{600, 128}, close{8192, 768};
constexpr Index near = 16, least_chosen = 400;
constexpr double roughly_round = 0.22, round = 0.29;
// The same of fewer, .19 to .2 within bodies, tells sheets apart that lie near each other.
constexpr Index nearest = 8;
constexpr double closely_round = 0.17;
// Such noise shows by points with others on one side, most of which stand out into the void, while
// bodies end abruptly: .14 to .2 of bodies, above .28 of noisy surfaces.
constexpr double aside = 0.25, thin = 0.3, abrupt = 0.235;
constexpr double vicinity = 0.08;  // of the cloud's size: what density is compared in

Points chosen_of(const Cloud& cloud, Index wanted, const Context& context) {
  const double share =
      std::min(1.0, static_cast<double>(wanted) / static_cast<double>(cloud.partition.total()));
  std::vector<Vector3> chosen;
  interruptible_for(context, cloud.points.size(), [&](Index i) {
    const Vector3 x = cloud.points[i];
    if (is_chosen(hash_of(x), share)) chosen.push_back(x);
  });
  return rows_of(cloud.partition.concatenate(chosen));
}

// Some of the cloud's points, and what is around them.
class Sample {
 public:
  Sample(const Cloud& cloud, const Effort& effort, const Context& context)
      : effort_(effort),
        points_(chosen_of(cloud, effort.chosen, context)),
        vicinity_(vicinity * cloud.frame.size),
        context_(context),
        tree_(points_) {}

  bool tells() const { return points_.rows() >= least_chosen; }

  struct Look {
    double roundness;  // in the median
    double one_sided;  // the share of points with others on one side
  };

  // At what is around points by their k nearest.
  Look look(Index k) const {
    const auto looks = of_surroundings<Look>(k, effort_.asked, [](const Surroundings& around) {
      const LeastEigen spread = least_eigen_of(around.covariance);
      return Look{spread.value / spread.greatest, around.one_sided() > aside ? 1.0 : 0.0};
    });
    std::vector<double> roundness;
    double one_sided = 0;
    for (const Look& look : looks) {
      roundness.push_back(look.roundness);
      one_sided += look.one_sided;
    }
    return {median(std::move(roundness)), one_sided / static_cast<double>(looks.size())};
  }

  // The share of points with few about them, compared with those in the vicinity.
  double standing_out() const {
    const auto densities =
        of_surroundings<double>(near, points_.rows(), [](const Surroundings& around) {
          return 1 / (around.radius * around.radius * around.radius);
        });
    std::vector<double> density(densities.size());
    for (std::size_t v = 0; v < density.size(); ++v) density[tree_.order()[v]] = densities[v];
    double looked = 0, found = 0;
    for (Index i = 0; i < points_.rows(); i += stride(effort_.asked)) {
      double sum = 0, count = 0;
      tree_.within(points_.row(i), vicinity_, [&](Index k, double) {
        sum += density[k];
        count += 1;
      });
      looked += 1;
      found += density[i] * count < thin * sum;
    }
    return found / looked;
  }

 private:
  Index stride(Index wanted) const { return std::max<Index>(1, points_.rows() / wanted); }

  // value(surroundings) of about as many points as wanted, along the tree's curve.
  template <typename T, typename Value>
  std::vector<T> of_surroundings(Index k, Index wanted, const Value& value) const {
    std::vector<Index> places;
    for (Index place = 0; place < points_.rows(); place += stride(wanted)) places.push_back(place);
    std::vector<T> values(places.size());
    visit_surroundings(points_, tree_, k, places, context_,
                       [&](Index v, const Surroundings& around) { values[v] = value(around); });
    return values;
  }

  Effort effort_;
  Points points_;
  double vicinity_;
  const Context& context_;
  PointTree tree_;
};

}  // namespace

bool is_volumetric(const Cloud& cloud, const Context& context) {
  const Sample few(cloud, rough, context);
  if (!few.tells() || !(few.look(near).roundness > roughly_round)) return false;
  const Sample many(cloud, close, context);
  const auto [roundness, one_sided] = many.look(near);
  return roundness > round && one_sided < abrupt && many.look(nearest).roundness > closely_round &&
         one_sided + 2 * many.standing_out() < abrupt;
}

}  // namespace symsurf
