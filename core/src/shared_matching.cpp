#include "shared_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "gathered.h"
#include "parallel.h"

namespace symsurf {

namespace {

constexpr Index own_chunk = 1 << 14, sent_chunk = 1 << 16;  // images at a time
constexpr Index grain = 4096;

struct Question {
  Vector3 image;
  double limit;  // squared: only nearer points count
};

struct Partner {
  Vector3 point = Vector3::Zero();
  Neighbour neighbour;  // numbered through all processes
};

struct Box {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;

  double squared_distance(const Vector3& x) const {
    return (low - x).cwiseMax(x - high).cwiseMax(0).squaredNorm();
  }
};

Box box_of(PointsView points) {
  Box box;
  for (Index i = 0; i < points.size(); ++i) {
    box.low = box.low.cwiseMin(points[i]);
    box.high = box.high.cwiseMax(points[i]);
  }
  return box;
}

// Answers from the own points what is asked about images that follow each other.
std::vector<Partner> answers(const std::vector<Question>& questions, PointsView own,
                             const PointTree& tree, Index first, const Context& context) {
  const Index count = static_cast<Index>(questions.size());
  std::vector<Partner> partners(questions.size());
  parallel_for(context, count, grain, [&](Index begin, Index end) {
    Index near = 0;
    for (Index q = begin; q < end; q += PointTree::block) {
      double farthest = 0;
      PointTree::Queries images;
      for (Index k = 0; k < PointTree::block; ++k) {
        const Question& asked = questions[std::min(q + k, end - 1)];
        images.col(k) = asked.image;
        farthest = std::max(farthest, asked.limit);
      }
      const auto found = tree.nearest(images, farthest, near);
      for (Index k = 0; k < PointTree::block && q + k < end; ++k)
        if (found[k].index >= 0 && found[k].squared_distance <= questions[q + k].limit)
          partners[q + k] = {own[found[k].index],
                             {first + found[k].index, found[k].squared_distance}};
    }
  });
  return partners;
}

// The partners of the own points among the points of all processes. Images are named by the place
// of their points along the tree's curve.
class SharedMatching {
 public:
  SharedMatching(PointsView own, PointTree&& tree, const Mirror& mirror, double limit,
                 const Context& context)
      : own_(own),
        tree_(std::move(tree)),
        context_(context),
        processes_(*context.communicator()),
        first_(share_of(context, own.size()).first),
        boxes_(concatenated(context, std::vector<Box>{box_of(own)})),
        index_(own.size(), -1),
        squared_(Eigen::VectorXd::Constant(own.size(), limit * limit)),
        opposite_(own.size(), 3) {
    images_.reserve(own.size());
    for (const std::int32_t i : tree_->order()) images_.push_back(mirror.reflect(own[i]));
  }

  // An image's partner is mostly where the image lies: found there first, it leaves little to look
  // for elsewhere.
  void match() {
    find_homes();
    consult_each([&](Index place, int process) { return home_[place] == process; });
    consult_each([&](Index place, int process) {
      return home_[place] != process && within_reach(place, process);
    });
  }

  void into(Result& result) && {
    const Index size = own_.size();
    Places place_of(size);
    for (Index p = 0; p < size; ++p) place_of[tree_->order()[p]] = static_cast<std::int32_t>(p);
    tree_.reset();
    images_ = std::vector<Vector3>();
    const Index found = size - std::count(index_.begin(), index_.end(), -1);
    result.pairs.resize(found, 2);
    result.residuals.resize(found);
    result.surface_points.resize(found, 3);
    for (Index i = 0, row = 0; i < size; ++i) {
      const std::int32_t p = place_of[i];
      if (index_[p] < 0) continue;
      result.pairs.row(row) << first_ + i, index_[p];
      result.residuals[row] = std::sqrt(squared_[p]);
      result.surface_points.row(row++) = (own_[i].transpose() + opposite_.row(p)) / 2;
    }
  }

 private:
  using Places = std::vector<std::int32_t>;

  using Part = std::span<const std::int32_t>;

  static Part part_of(Part places, std::size_t from, std::size_t count) {
    const std::size_t begin = std::min(from, places.size());
    return places.subspan(begin, std::min(count, places.size() - begin));
  }

  // An image's home is the process whose box is nearest, of several this one.
  void find_homes() {
    const Index size = own_.size();
    home_.assign(size, processes_.rank());
    for (Index p = 0; p < size; ++p) {
      if (p % own_chunk == 0) context_.check();
      double nearest = boxes_[home_[p]].squared_distance(images_[p]);
      for (int process = 0; nearest > 0 && process < processes_.size(); ++process) {
        const double distance = boxes_[process].squared_distance(images_[p]);
        if (distance >= nearest) continue;
        nearest = distance;
        home_[p] = process;
      }
    }
  }

  // May points of that process be nearer to the image than its best so far?
  bool within_reach(Index place, int process) const {
    return boxes_[process].squared_distance(images_[place]) <= squared_[place];
  }

  // Asks every process about the images chosen for it, and answers its questions. Each round pairs
  // the processes off: whoever is mine, I am his; who is left alone asks himself meanwhile.
  template <typename Chosen>
  void consult_each(const Chosen& chosen) {
    const int size = processes_.size();
    for (int round = 0; round < size; ++round) {
      const int process = (round - processes_.rank() + size) % size;
      Places places;
      for (Index p = 0; p < own_.size(); ++p)
        if (chosen(p, process)) places.push_back(static_cast<std::int32_t>(p));
      if (process == processes_.rank())
        ask_own(places);
      else
        ask_other(process, places);
    }
  }

  void ask_own(Part places) {
    for (std::size_t at = 0; at < places.size(); at += own_chunk) {
      const Part asked = part_of(places, at, own_chunk);
      keep_nearer(asked, answered(questions(asked)));
    }
  }

  void ask_other(int other, Part places) {
    const auto counts = items_of<std::size_t>(
        processes_.swap(other, bytes_of(std::vector<std::size_t>{places.size()})));
    const std::size_t most = std::max(places.size(), counts.front());
    for (std::size_t at = 0; at < most; at += sent_chunk) {
      const Part asked = part_of(places, at, sent_chunk);
      const auto given = items_of<Question>(processes_.swap(other, bytes_of(questions(asked))));
      keep_nearer(asked, items_of<Partner>(processes_.swap(other, bytes_of(answered(given)))));
    }
  }

  std::vector<Question> questions(Part places) const {
    std::vector<Question> asked;
    asked.reserve(places.size());
    for (const std::int32_t place : places) asked.push_back({images_[place], squared_[place]});
    return asked;
  }

  std::vector<Partner> answered(const std::vector<Question>& questions) const {
    return answers(questions, own_, *tree_, first_, context_.stage(0, 0));
  }

  void keep_nearer(Part places, const std::vector<Partner>& partners) {
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto& [point, neighbour] = partners[k];
      const std::int32_t i = places[k];
      if (neighbour.index < 0) continue;
      if (index_[i] >= 0 && !(neighbour < Neighbour{index_[i], squared_[i]})) continue;
      index_[i] = neighbour.index;
      squared_[i] = neighbour.squared_distance;
      opposite_.row(i) = point.transpose();
    }
    asked_ += places.size();
    if (!places.empty())
      context_.report(
          std::min(1.0, static_cast<double>(asked_) / static_cast<double>(own_.size())));
  }

  PointsView own_;
  std::optional<PointTree> tree_;
  const Context& context_;
  const Communicator& processes_;
  Index first_;
  std::vector<Box> boxes_;
  std::vector<Vector3> images_;  // this and all else by place
  std::vector<std::int32_t> home_;
  std::size_t asked_ = 0;
  // The best so far: numbered through all processes, -1 none; squared distance; the point.
  std::vector<Index> index_;
  Eigen::VectorXd squared_;
  Points opposite_;
};

}  // namespace

void add_shared_pairs(Result& result, PointsView own, PointTree&& tree, const Mirror& mirror,
                      double limit, const Context& context) {
  SharedMatching matching(own, std::move(tree), mirror, limit, context);
  matching.match();
  std::move(matching).into(result);
}

}  // namespace symsurf
