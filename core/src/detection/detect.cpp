#include <symsurf/context.h>
#include <symsurf/detect.h>

#include <chrono>
#include <optional>
#include <vector>

#include "detection/pipeline.h"
#include "detection/run_on_root.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

// A distributed cloud takes longer to redistribute than one process to search where it is smaller.
constexpr Index small_cloud = 8192;

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

Cloud cloud_of(PointsView points, PointsView normals, const Options& options,
               double tolerance = usual_tolerance) {
  Cloud cloud;
  cloud.points = points;
  cloud.normals = normals;
  cloud.partition = Partition(points.size());
  cloud.seed = options.seed;
  cloud.tolerance = tolerance;
  return cloud;
}

// By all pairs, before they are shared out: a process without points has none of its own.
Result judged(Result result, const ParameterValues& values) {
  judge(result, result.mirror || result.pairs.rows() > 0, values.real("minimum_score"));
  return result;
}

Result detect_in_one(PointsView points, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context) {
  Cloud cloud = cloud_of(points, options.normals, options, values.real("tolerance"));
  cloud.faces = options.faces;
  return judged(*run_pipeline(method, values, cloud, options.refuse_nonfinite, context), values);
}

// Several processes see the points only, not the faces.
Result detect_distributed(PointsView own, const Options& options,
                          const MethodImplementation& method, const ParameterValues& values,
                          const Context& context) {
  const JointCancellation processes(context);
  Cloud cloud = cloud_of(own, {}, options, values.real("tolerance"));
  cloud.partition = Partition(own.size(), &processes);
  const bool has_normals = cloud.partition.sum(options.normals.size()) > 0;
  if (method.preprocessing.distributed && !has_normals && cloud.partition.total() > small_cloud) {
    const std::optional<Result> result =
        run_pipeline(method, values, cloud, options.refuse_nonfinite, processes.context());
    if (result) return judged(*result, values);
  }
  // The context of the host: the root is the one to be cancelled.
  return run_on_root(
      own, options.normals, *context.communicator(), [&](PointsView points, PointsView normals) {
        return judged(*run_pipeline(method, values,
                                    cloud_of(points, normals, options, values.real("tolerance")),
                                    options.refuse_nonfinite, context),
                      values);
      });
}

}  // namespace

Result detect(PointsView points, const Options& options, const Context& context) {
  const auto start = std::chrono::steady_clock::now();
  const MethodImplementation& method = implementation(options.method);
  const ParameterValues values(method.name, method.parameters, options.parameters);
  const auto run = context.communicator() ? detect_distributed : detect_in_one;
  Result result = run(points, options, method, values, context);
  if (result.parameters.empty()) result.parameters = values.all();
  context.report(1);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

double diagonal(PointsView points, const Options& options, const Context& context) {
  const MethodImplementation& method = implementation(options.method);
  double found = 0;
  MethodImplementation measuring;  // in place of the method
  measuring.name = method.name;
  measuring.minimum_points = method.minimum_points;
  measuring.preprocessing = Preprocessing::none();
  measuring.preprocessing.remove_outliers = method.preprocessing.remove_outliers;
  measuring.run = [&found](const Cloud& cloud, const ParameterValues&, const Context&) {
    found = cloud.diagonal;
    return Result{};
  };
  run_pipeline(measuring, {}, cloud_of(points, {}, options), options.refuse_nonfinite, context);
  return found;
}

}  // namespace symsurf
