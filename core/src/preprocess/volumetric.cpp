#include "preprocess/volumetric.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "base/symmetric_eigen.h"
#include "cloud/neighbourhood_moments.h"
#include "spatial/triple_index.h"

namespace symsurf {

namespace {

// A sample of the points decides whether a cloud is volumetric: first a few, as most are not. The
// roundness, squared thickness over squared length of the neighbourhood of a point, is .3 to .35
// within bodies, in the median, and less on surfaces, unless noise as large as their points'
// spacing blurs them.
struct Effort {
  Index sampled, queried;
};
constexpr Effort rough{600, 128}, close{8192, 768};
constexpr Index near = 16, least_sampled = 400;
constexpr double roughly_round = 0.22, round = 0.29;
// The same of fewer neighbours, .19 to .2 within bodies, distinguishes surfaces near each other.
constexpr Index nearest = 8;
constexpr double closely_round = 0.17;
// Such noise shows by the share of points with neighbours on one side, most of them sparse, while
// bodies end abruptly: .14 to .2 of bodies, above .28 of noisy surfaces.
constexpr double aside = 0.25, thin = 0.3, abrupt = 0.235;
constexpr double vicinity = 0.08;  // of the cloud's size: what density is compared in

Points sampled_of(const Cloud& cloud, Index wanted, const Context& context) {
  const double share =
      std::min(1.0, static_cast<double>(wanted) / static_cast<double>(cloud.partition.total()));
  std::vector<Vector3> chosen;
  interruptible_for(context, cloud.points.size(), [&](Index i) {
    const Vector3 x = cloud.points[i];
    if (is_chosen(hash_of(x), share)) chosen.push_back(x);
  });
  return rows_of(cloud.partition.concatenate(chosen));
}

// Some of the cloud's points, and their neighbourhoods.
class Sample {
 public:
  Sample(const Cloud& cloud, const Effort& effort, const Context& context)
      : effort_(effort),
        points_(sampled_of(cloud, effort.sampled, context)),
        vicinity_(vicinity * cloud.frame.size),
        context_(context),
        tree_(points_) {}

  bool is_enough() const { return points_.rows() >= least_sampled; }

  struct Look {
    double roundness;  // in the median
    double one_sided;  // the share of points with others on one side
  };

  // By the k nearest of each point.
  Look look(Index k) const {
    const auto looks =
        of_surroundings<Look>(k, effort_.queried, [](const NeighbourhoodMoments& around) {
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

  // The share of points that are sparse, compared with those in the vicinity.
  double sparse_share() const {
    const auto densities =
        of_surroundings<double>(near, points_.rows(), [](const NeighbourhoodMoments& around) {
          return 1 / (around.radius * around.radius * around.radius);
        });
    std::vector<double> density(densities.size());
    for (std::size_t v = 0; v < density.size(); ++v) density[tree_.order()[v]] = densities[v];
    double looked = 0, found = 0;
    for (Index i = 0; i < points_.rows(); i += stride(effort_.queried)) {
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

  // value(surroundings) of about as many points as wanted, in the tree's order.
  template <typename T, typename Value>
  std::vector<T> of_surroundings(Index k, Index wanted, const Value& value) const {
    std::vector<Index> positions;
    for (Index position = 0; position < points_.rows(); position += stride(wanted))
      positions.push_back(position);
    std::vector<T> values(positions.size());
    visit_neighbourhoods(
        points_, tree_, k, positions, context_,
        [&](Index v, const NeighbourhoodMoments& around) { values[v] = value(around); });
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
  if (!few.is_enough() || !(few.look(near).roundness > roughly_round)) return false;
  const Sample many(cloud, close, context);
  const auto [roundness, one_sided] = many.look(near);
  return roundness > round && one_sided < abrupt && many.look(nearest).roundness > closely_round &&
         one_sided + 2 * many.sparse_share() < abrupt;
}

}  // namespace symsurf
