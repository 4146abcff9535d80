#include "shared_run.h"

#include <symsurf/communicator.h>
#include <symsurf/errors.h>

#include <vector>

#include "cloud.h"
#include "fills_bodies.h"
#include "gathered.h"
#include "outline.h"
#include "run_alone.h"
#include "run_on_first.h"
#include "shared_cloud.h"
#include "strays.h"

namespace symsurf {

namespace {

constexpr Index small_cloud = 8192;  // that takes longer to share out than to search

// Where one process is told to stop, all stop, the next time they gather: one that left alone would
// keep the others waiting for ever.
class StoppingTogether : public Communicator {
 public:
  explicit StoppingTogether(const Context& outer)
      : outer_(outer), processes_(*outer.communicator()) {}

  Context context() const {
    const auto report = [this](double fraction) {
      try {
        outer_.report(fraction);
      } catch (const Cancelled&) {
        stopped_ = true;
      }
      return true;
    };
    return Context(report, outer_.threads()).sharing(this);
  }

  int rank() const override { return processes_.rank(); }
  int size() const override { return processes_.size(); }

  std::vector<Bytes> gather(std::span<const std::byte> mine) const override {
    Bytes bytes(mine.begin(), mine.end());
    bytes.push_back(std::byte{stopped_});
    std::vector<Bytes> all = processes_.gather(bytes);
    bool stopped = false;
    for (Bytes& part : all) {
      stopped = stopped || part.back() != std::byte{0};
      part.pop_back();
    }
    if (stopped) throw Cancelled();
    return all;
  }

  Bytes swap(int other, std::span<const std::byte> mine) const override {
    return processes_.swap(other, mine);
  }

 private:
  const Context& outer_;
  const Communicator& processes_;
  mutable bool stopped_ = false;
};

// What all of them would find alike: the others leave the first the processors.
Result run_on_whole(PointsView own, const Options& options, const Method& method,
                    const ParameterValues& values, const Context& context) {
  const Context alone = context.sharing(nullptr);
  return run_on_first(own, options.normals, *context.communicator(),
                      [&](PointsView points, PointsView normals) {
                        return run_alone(points, normals, options.seed, method, values, alone);
                      });
}

}  // namespace

Result detect_shared(PointsView own, const Options& options, const Method& method,
                     const ParameterValues& values, const Context& context) {
  const StoppingTogether together(context);
  const Context shared = together.context();
  const Index normals = share_of(shared, options.normals.size()).total;
  if (!method.takes_shares || normals > 0 || share_of(shared, own.size()).total <= small_cloud)
    return run_on_whole(own, options, method, values, context);
  const Context unreported = shared.stage(0, 0);
  Cloud cloud = checked_shared_cloud(own, method.minimum_points, unreported);
  const auto strays = Strays::where_any(cloud, method, unreported);
  Points rest;
  if (strays) {
    rest = strays->rows(own);
    cloud = checked_shared_cloud(rest, method.minimum_points, unreported);
  }
  if (!method.sees_inside && fills_bodies(cloud, unreported))
    return run_on_whole(own, options, method, values, context);
  cloud.seed = options.seed;
  Result result = method.run(cloud, values, shared);
  set_footprint(result, outline(cloud.points, shared));
  if (strays) strays->hand_on(result);
  return result;
}

}  // namespace symsurf
