#include <symsurf/context.h>
#include <symsurf/point_summary.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/linear_algebra.h"
#include "base/parallel.h"
#include "detection/pipeline.h"
#include "processes.h"

namespace symsurf {

namespace {

// A communicator whose processes stop together: where one is cancelled, all throw at their next
// all-gather. Otherwise they would wait for it for ever.
class JointCancellation : public Communicator {
 public:
  explicit JointCancellation(const Context& outer)
      : outer_(outer), processes_(*outer.communicator()) {}

  Context context() const {
    const auto report = [this](double fraction) {
      try {
        outer_.report(fraction);
      } catch (const Cancelled&) {
        cancelled_ = true;
      }
      return true;
    };
    return Context(report, outer_.threads());
  }

  int rank() const override { return processes_.rank(); }
  int size() const override { return processes_.size(); }

  std::vector<Bytes> all_gather(std::span<const std::byte> own) const override {
    Bytes bytes(own.begin(), own.end());
    bytes.push_back(std::byte{cancelled_});
    std::vector<Bytes> all = processes_.all_gather(bytes);
    bool cancelled = false;
    for (Bytes& part : all) {
      cancelled = cancelled || part.back() != std::byte{0};
      part.pop_back();
    }
    if (cancelled) throw Cancelled();
    return all;
  }

  Bytes send_recv(int other, std::span<const std::byte> bytes) const override {
    return processes_.send_recv(other, bytes);
  }

 private:
  const Context& outer_;
  const Communicator& processes_;
  mutable bool cancelled_ = false;
};

// Of all on the root, of some on the others; in as many rounds as a tree has levels.
void merge_on_root(PointSummary& summary, const Communicator& processes) {
  const int rank = processes.rank();
  for (int step = 1; step < processes.size(); step *= 2) {
    if (rank % (2 * step) == step) {
      processes.send_recv(rank - step, summary.bytes());
      break;
    }
    if (rank + step < processes.size())
      summary.add(PointSummary::from_bytes(processes.send_recv(rank + step, {})));
  }
}

// What the others need of the thinned points, to look for partners.
struct Layout {
  Vector3 centre = Vector3::Zero();
  Vector3 along = Vector3::UnitX();  // the mirror, where the cloud extends most
  double diagonal = 0;
};

// Slabs across such a direction hold most points with their partners.
Vector3 along_mirror(const Mirror& mirror, const Points& thinned, const PrincipalFrame& frame) {
  Matrix3 chords = Matrix3::Zero();
  for (const auto row : thinned.rowwise()) {
    const Vector3 x = row.transpose(), chord = mirror.reflect(x) - x;
    if (chord.allFinite()) chords += chord * chord.transpose();
  }
  const Vector3 across = eigen_of(chords).vectors.col(2);
  const Matrix3 onto = Matrix3::Identity() - across * across.transpose();
  const Matrix3 variance = frame.axes * frame.variance.asDiagonal() * frame.axes.transpose();
  return eigen_of(Matrix3(onto * variance * onto)).vectors.col(2);
}

Layout layout_of(const Result& result, const Points& thinned, const Options& options,
                 const MethodImplementation& method) {
  const PrincipalFrame frame = principal_frame(thinned, Context());
  return {frame.centroid, along_mirror(*result.mirror, thinned, frame),
          diagonal_of(thinned, options, method, Context())};
}

// Of the points that were given, in place of the thinned ones.
void add_own_pairs(Result& result, PointsView own, const Partition& whole, const Layout& layout,
                   const Finder& finder, const Context& context) {
  const Slabs slabs(own, whole, layout.along, layout.centre, layout.diagonal,
                    context.stage(0, 0.2));
  PointTree tree(slabs.points(), context.stage(0.2, 0.4));
  add_pairs(result, own, slabs, std::move(tree), *finder.pair_distance * layout.diagonal,
            context.stage(0.4, 1));
  report_pairs(result, finder.method, whole.sum(Index{result.pairs.rows()}), whole.total(),
               whole.sum(result.residuals.sum()));
}

void require_own(PointsView own, const Options& options, Index first) {
  require_numerable(own.size());
  if (options.refuse_nonfinite) require_finite(own, "point", first);
  require_coordinates(own, first);
}

// By a summary of the points on the root, whatever their number.
Result detect_thinned(PointsView own, const Options& options, const MethodImplementation& method,
                      const ParameterValues& values, const Context& context) {
  const JointCancellation processes(context);
  const Partition whole(own.size(), processes);
  whole.require([&] { require_own(own, options, whole.first()); });
  PointSummary summary;
  summary.add(own);
  const Index nonfinite = whole.sum(summary.nonfinite());
  merge_on_root(summary, processes);
  const Points thinned = processes.rank() == 0 ? summary.means() : Points(0, 3);
  Options without_pairs = options;
  without_pairs.parameters["pairs"] = false;
  without_pairs.faces = {};
  const ParameterValues used(method.name, method.parameters, without_pairs.parameters);
  Result result =
      run_on_root(thinned, {}, *context.communicator(), [&](PointsView points, PointsView) {
        return detect_in_one(points, without_pairs, method, used, context.stage(0.1, 0.6));
      });
  if (result.parameters.contains("pairs")) result.parameters["pairs"] = values.boolean("pairs");
  if (nonfinite > 0) result.statistics["nonfinite_points"] = nonfinite;
  const Finder finder = finder_of(result, method, values);
  if (!result.mirror || !finder.pair_distance) return result;
  std::vector<Layout> layout;
  if (processes.rank() == 0) layout = {layout_of(result, thinned, options, method)};
  layout = all_gather(processes, layout).front();
  const Context rest = processes.context();
  add_own_pairs(result, own, whole, layout.front(), finder, rest.stage(0.6, 1));
  return result;
}

// Thesis and baselines see the points as they are.
bool may_be_thinned(const MethodImplementation& method) {
  return !method.preprocessing.order_points;
}

}  // namespace

Result detect_shared(PointsView own, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context) {
  const Communicator& processes = *context.communicator();
  const Index count = Partition(own.size(), processes).total();
  const bool has_normals = Partition(options.normals.size(), processes).total() > 0;
  // The root has room for as many points as a summary has.
  if (may_be_thinned(method) && !has_normals && count > PointSummary::usual_cells)
    return detect_thinned(own, options, method, values, context);
  return run_on_root(own, options.normals, processes, [&](PointsView points, PointsView normals) {
    Options all = options;
    all.normals = normals;
    all.faces = {};
    return detect_in_one(points, all, method, values, context);
  });
}

namespace {

constexpr std::size_t chunk = 1 << 16;  // images sent at a time
constexpr Index grain = 4096;

struct Question {
  Vector3 image;
  double limit;  // squared: only points as near count
};

struct Partner {
  Vector3 point = Vector3::Zero();
  Neighbour neighbour;  // numbered through all processes
};

// The partners of a slab's points among the points of all slabs.
class DistributedMatching {
 public:
  DistributedMatching(const Slabs& slabs, PointTree&& tree, const Mirror& mirror, double limit,
                      const Context& context)
      : slabs_(slabs),
        tree_(std::move(tree)),
        mirror_(mirror),
        limit_(limit),
        context_(context),
        processes_(slabs.partition().processes()),
        found_(find_partners(slabs.points(), *tree_, mirror, limit, context)) {
    for_each_pair(processes_, [&](int other) { consult(other); });
    tree_.reset();
  }

  Partner operator[](Index i) const {
    const std::int32_t k = found_.index[i];
    if (k < 0) return {};
    const Index size = slabs_.points().size();
    if (k >= size) return others_[k - size];
    return {slabs_.points()[k], {slabs_.number(k), found_.squared[i]}};
  }

 private:
  using Positions = std::span<const std::int32_t>;

  // In the tree's order: images that follow each other lie close together.
  std::vector<std::int32_t> within_reach_of(int process) const {
    std::vector<bool> within(found_.index.size());
    for (std::size_t i = 0; i < within.size(); ++i) {
      const double distance = slabs_.distance(mirror_.reflect(slabs_.points()[i]), process);
      within[i] = distance * distance <= best(i);
    }
    std::vector<std::int32_t> positions;
    std::copy_if(tree_->order().begin(), tree_->order().end(), std::back_inserter(positions),
                 [&](std::int32_t i) { return within[i]; });
    return positions;
  }

  // Squared.
  double best(Index i) const { return found_.index[i] < 0 ? limit_ * limit_ : found_.squared[i]; }

  // Asks about images that may have a nearer partner there, and answers the other's questions.
  void consult(int other) {
    const std::vector<std::int32_t> positions = within_reach_of(other);
    const auto counts = send_recv(processes_, other, std::vector<std::size_t>{positions.size()});
    for (std::size_t at = 0; at < std::max(positions.size(), counts.front()); at += chunk) {
      const std::size_t begin = std::min(at, positions.size());
      const Positions asked(positions.data() + begin, std::min(chunk, positions.size() - begin));
      const auto given = send_recv(processes_, other, questions(asked));
      keep_nearer(asked, send_recv(processes_, other, answers(given)));
    }
  }

  std::vector<Question> questions(Positions positions) const {
    std::vector<Question> asked;
    asked.reserve(positions.size());
    for (const std::int32_t i : positions)
      asked.push_back({mirror_.reflect(slabs_.points()[i]), best(i)});
    return asked;
  }

  std::vector<Partner> answers(const std::vector<Question>& questions) const {
    const Index count = static_cast<Index>(questions.size());
    std::vector<Partner> partners(questions.size());
    parallel_for(context_.stage(0, 0), count, grain, [&](Index begin, Index end) {
      for (Index q = begin; q < end; ++q) {
        const auto [index, squared] = tree_->nearest(questions[q].image, questions[q].limit);
        if (index >= 0) partners[q] = {slabs_.points()[index], {slabs_.number(index), squared}};
      }
    });
    return partners;
  }

  void keep_nearer(Positions positions, const std::vector<Partner>& partners) {
    for (std::size_t k = 0; k < positions.size(); ++k) {
      const std::int32_t i = positions[k];
      if (!(partners[k].neighbour < (*this)[i].neighbour)) continue;
      found_.index[i] = static_cast<std::int32_t>(slabs_.points().size() + others_.size());
      found_.squared[i] = partners[k].neighbour.squared_distance;
      others_.push_back(partners[k]);
    }
  }

  const Slabs& slabs_;
  std::optional<PointTree> tree_;  // until all are found
  const Mirror& mirror_;
  double limit_;
  const Context& context_;
  const Communicator& processes_;
  Partners found_;               // indices from the slab's size on: of others_
  std::vector<Partner> others_;  // in other slabs
};

// All points that this process had get a row; -1 for the partner of one that has none.
void send_back(Result& result, PointsView own, Index first, const Slabs& slabs,
               const DistributedMatching& matching) {
  const Index size = own.size();
  // The largest first, into the space that the tree left.
  result.surface_points.resize(size, 3);
  result.pairs.resize(size, 2);
  result.residuals.resize(size);
  slabs.send_back<Partner>([&](Index k) { return matching[k]; },
                           [&](Index i, const Partner& partner) {
                             result.surface_points.row(i) =
                                 (own[i] + partner.point).transpose() / 2;
                             result.pairs.row(i) << first + i, partner.neighbour.index;
                             result.residuals[i] = std::sqrt(partner.neighbour.squared_distance);
                           });
}

void drop_unpaired(Result& result) {
  // Eigen's columns of no rows would be an offset to a null pointer.
  if (result.pairs.rows() == 0 || (result.pairs.col(1).array() >= 0).all()) return;
  std::vector<Index> found;
  for (Index row = 0; row < result.pairs.rows(); ++row)
    if (result.pairs(row, 1) >= 0) found.push_back(row);
  keep_pairs(result, found);
}

}  // namespace

void add_pairs(Result& result, PointsView own, const Slabs& slabs, PointTree&& tree, double limit,
               const Context& context) {
  send_back(result, own, slabs.partition().first(), slabs,
            DistributedMatching(slabs, std::move(tree), *result.mirror, limit, context));
  drop_unpaired(result);
}

}  // namespace symsurf
