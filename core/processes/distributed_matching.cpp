#include "distributed_matching.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace symsurf {

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
