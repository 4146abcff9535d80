#include "shared_matching.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "gathered.h"
#include "parallel.h"

namespace symsurf {

namespace {

constexpr Index chunk = 1 << 16;  // images at a time
constexpr Index grain = 4096;

struct Question {
  Vector3 image;
  double limit;  // squared: only nearer points count
};

struct Partner {
  Vector3 point = Vector3::Zero();
  Neighbour neighbour;  // numbered through all processes
};

// Squared: only nearer points count.
double limit_of(const Question& question, const Partner& best) {
  return std::min(question.limit, best.neighbour.squared_distance);
}

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
class OwnPoints {
 public:
  OwnPoints(PointsView points, const PointTree& tree, Index first, const Context& context)
      : points_(points), tree_(tree), first_(first), context_(context) {}

  std::vector<Partner> answers(const std::vector<Question>& questions) const {
    const Index count = static_cast<Index>(questions.size());
    std::vector<Partner> partners(questions.size());
    parallel_for(context_, count, grain, [&](Index begin, Index end) {
      Index near = 0;
      for (Index q = begin; q < end; q += PointTree::block) {
        double farthest = 0;
        PointTree::Queries images;
        for (Index k = 0; k < PointTree::block; ++k) {
          const Question& asked = questions[std::min(q + k, end - 1)];
          images.col(k) = asked.image;
          farthest = std::max(farthest, asked.limit);
        }
        const auto found = tree_.nearest(images, farthest, near);
        for (Index k = 0; k < PointTree::block && q + k < end; ++k)
          if (found[k].index >= 0 && found[k].squared_distance <= questions[q + k].limit)
            partners[q + k] = {points_[found[k].index],
                               {first_ + found[k].index, found[k].squared_distance}};
      }
    });
    return partners;
  }

 private:
  PointsView points_;
  const PointTree& tree_;
  Index first_;
  Context context_;
};

// Those images that points within the box may be nearer to than their best so far.
std::vector<std::size_t> within_reach(const Box& box, const std::vector<Question>& images,
                                      const std::vector<Partner>& best) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < images.size(); ++i)
    if (box.squared_distance(images[i].image) <= limit_of(images[i], best[i])) rows.push_back(i);
  return rows;
}

std::vector<Question> about(const std::vector<std::size_t>& rows,
                            const std::vector<Question>& images, const std::vector<Partner>& best) {
  std::vector<Question> asked;
  asked.reserve(rows.size());
  for (const std::size_t i : rows) asked.push_back({images[i].image, limit_of(images[i], best[i])});
  return asked;
}

void keep_nearer(const std::vector<std::size_t>& rows, const std::vector<Partner>& answers,
                 std::vector<Partner>& best) {
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (answers[k].neighbour.index >= 0 && answers[k].neighbour < best[rows[k]].neighbour)
      best[rows[k]] = answers[k];
}

// Asks another process about those images that its points may be nearer to, and answers it.
void consult(const Communicator& processes, int other, const Box& box, const OwnPoints& own,
             const std::vector<Question>& images, std::vector<Partner>& best) {
  const std::vector<std::size_t> rows = within_reach(box, images, best);
  const auto questions =
      items_of<Question>(processes.swap(other, bytes_of(about(rows, images, best))));
  const std::vector<Partner> given = own.answers(questions);
  keep_nearer(rows, items_of<Partner>(processes.swap(other, bytes_of(given))), best);
}

// Whose box holds an image, or is nearest to it, mostly has its partner; found there first, it
// leaves little to look for elsewhere.
std::vector<std::size_t> at_home(int rank, const std::vector<Box>& boxes,
                                 const std::vector<Question>& images) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const double own = boxes[rank].squared_distance(images[i].image);
    const auto no_nearer = [&](const Box& box) {
      return own <= box.squared_distance(images[i].image);
    };
    if (own == 0 || std::all_of(boxes.begin(), boxes.end(), no_nearer)) rows.push_back(i);
  }
  return rows;
}

}  // namespace

void add_shared_pairs(Result& result, PointsView own, PointTree&& tree, const Mirror& mirror,
                      double limit, const Context& context) {
  auto consumed = std::make_unique<const PointTree>(std::move(tree));
  const Communicator& processes = *context.communicator();
  const Index size = own.size();
  const Share share = share_of(context, size);
  const std::vector<Box> boxes = concatenated(context, std::vector<Box>{box_of(own)});
  const std::vector<Index> sizes = concatenated(context, std::vector<Index>{size});
  const Index chunks = (*std::max_element(sizes.begin(), sizes.end()) + chunk - 1) / chunk;

  std::vector<Index> partner(size);
  Eigen::VectorXd& residuals = result.residuals;
  Points& surface_points = result.surface_points;
  residuals.resize(size);
  surface_points.resize(size, 3);
  for (Index c = 0; c < chunks; ++c) {
    const Context part = context.stage(static_cast<double>(c) / static_cast<double>(chunks),
                                       static_cast<double>(c + 1) / static_cast<double>(chunks));
    const OwnPoints answering(own, *consumed, share.first, part.stage(0, 0));
    const Index begin = std::min(size, c * chunk), end = std::min(size, begin + chunk);
    std::vector<Question> images;
    images.reserve(end - begin);
    for (Index p = begin; p < end; ++p)
      images.push_back({mirror.reflect(own[consumed->order()[p]]), limit * limit});
    std::vector<Partner> best(images.size());
    const auto ask_own = [&](const std::vector<std::size_t>& rows) {
      keep_nearer(rows, answering.answers(about(rows, images, best)), best);
    };
    const std::vector<std::size_t> home = at_home(processes.rank(), boxes, images);
    ask_own(home);
    // Each round pairs the processes off: whoever is mine, I am his.
    for (int round = 0; round < processes.size(); ++round) {
      const int other = (round - processes.rank() + processes.size()) % processes.size();
      if (other != processes.rank())
        consult(processes, other, boxes[other], answering, images, best);
    }
    std::vector<std::size_t> rest = within_reach(boxes[processes.rank()], images, best);
    std::erase_if(rest,
                  [&](std::size_t i) { return std::binary_search(home.begin(), home.end(), i); });
    ask_own(rest);
    for (Index p = begin; p < end; ++p) {
      const Index i = consumed->order()[p];
      const auto& [opposite, neighbour] = best[p - begin];
      partner[i] = neighbour.index;
      residuals[i] = std::sqrt(neighbour.squared_distance);
      surface_points.row(i) = (own[i] + opposite).transpose() / 2;
    }
  }
  consumed.reset();

  const Index found = size - std::count(partner.begin(), partner.end(), -1);
  result.pairs.resize(found, 2);
  for (Index i = 0, row = 0; i < size; ++i) {
    if (partner[i] < 0) continue;
    result.pairs.row(row) << share.first + i, partner[i];
    residuals[row] = residuals[i];
    surface_points.row(row++) = surface_points.row(i).eval();
  }
  residuals.conservativeResize(found);
  surface_points.conservativeResize(found, 3);
}

}  // namespace symsurf
