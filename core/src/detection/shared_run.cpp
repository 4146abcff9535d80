#include "detection/shared_run.h"

#include <symsurf/communicator.h>
#include <symsurf/errors.h>

#include <optional>
#include <vector>

#include "base/gathered.h"
#include "cloud/cloud.h"
#include "cloud/outline.h"
#include "detection/run_alone.h"
#include "detection/run_on_first.h"
#include "detection/shared_cloud.h"
#include "preprocess/fills_bodies.h"
#include "preprocess/nonfinite_removal.h"
#include "preprocess/strays.h"

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

// What all of them would find alike: the others leave the first the processors. `context`: as the
// host gave it, since the first is the one to be told to stop.
Result run_on_whole(PointsView own, const Options& options, const Method& method,
                    const ParameterValues& values, const Context& context) {
  const Context alone = context.sharing(nullptr);
  return run_on_first(own, options.normals, *context.communicator(),
                      [&](PointsView points, PointsView normals) {
                        Options of_all;
                        of_all.normals = normals;
                        of_all.seed = options.seed;
                        of_all.refuse_nonfinite = options.refuse_nonfinite;
                        return run_alone(points, of_all, method, values, alone);
                      });
}

Result run_on_finite(PointsView own, const Options& options, const Method& method,
                     const ParameterValues& values, const Context& context, const Context& shared) {
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

}  // namespace

Result detect_shared(PointsView own, const Options& options, const Method& method,
                     const ParameterValues& values, const Context& context) {
  const StoppingTogether together(context);
  const Context shared = together.context(), unreported = shared.stage(0, 0);
  std::optional<NonfiniteRemoval> nonfinite;
  if (!options.refuse_nonfinite)
    nonfinite = NonfiniteRemoval::where_any(own, method.minimum_points, unreported);
  if (!nonfinite) return run_on_finite(own, options, method, values, context, shared);

  const Share share = share_of(shared, own.size());
  check_together(unreported, [&] { require_normals(own, options.normals, share.first); });
  const Points finite = nonfinite->apply(own);
  const Points normals = options.normals.empty() ? Points(0, 3) : nonfinite->apply(options.normals);
  Options of_finite = options;
  of_finite.normals = normals;
  Result result = run_on_finite(finite, of_finite, method, values, context, shared);
  nonfinite->map_back(result);
  return result;
}

}  // namespace symsurf
