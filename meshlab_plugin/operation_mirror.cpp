// SPDX-License-Identifier: GPL-3.0-or-later
#include "operation_mirror.h"

#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include "mirror_layer.h"
#include "result_layers.h"

namespace symsurf::meshlab {

namespace {

// A layer added here is replaced when the filter of the same method runs.
constexpr const char* finding_filter = "compute_mirror_auto";

Points placed_points(const OperationResult& result) {
  Points placed(result.points.rows(), 3);
  Index count = 0;
  for (const auto& point : result.points.rowwise())
    if (point.allFinite()) placed.row(count++) = point;
  return placed.topRows(count);
}

// Whether a shape that was straightened is bent again.
bool goes_back(const Values& parameters) {
  const auto back = parameters.find("back");
  return back != parameters.end() && std::get<bool>(back->second);
}

// What the mirror of a shape that was straightened has become: the plane that it was laid into, or
// bent again what it was before.
std::shared_ptr<const Mirror> reshaped(std::shared_ptr<const Mirror> mirror,
                                       const OperationResult& result) {
  const Values& statistics = result.statistics;
  const auto normal = statistics.find("normal"), offset = statistics.find("offset");
  if (normal == statistics.end() || offset == statistics.end() || mirror->kind() == "plane")
    return nullptr;
  if (goes_back(result.parameters)) return mirror;
  return std::make_shared<Plane>(std::get<Vector3>(normal->second),
                                 std::get<double>(offset->second));
}

}  // namespace

OperationMirror::OperationMirror(const MeshModel& layer, MeshModel& holder,
                                 const Values& parameters)
    : holder_(&holder) {
  if (goes_back(parameters) && holder.cm.Tr == layer.cm.Tr) mirror_ = bent_mirror_of(holder);
  if (!mirror_) mirror_ = mirror_beside(layer, holder);
}

OperationMirror::OperationMirror(const LayerCloud& cloud, bool require_found,
                                 const Context& context) {
  Options options;
  options.faces = cloud.faces;
  const Result result = detect(cloud.points, options, context);
  const FoundMirror found = found_mirror(result, require_found);
  mirror_ = found.mirror;
  log_ = {"found first: " + std::string(mirror_->kind()) + ", score " +
          to_string(Value(result.score))};
  if (!found.warning.empty()) log_.push_back(found.warning);
}

const MeshModel& OperationMirror::place(MeshDocument& document, const MeshModel& layer,
                                        const OperationResult& result) const {
  const std::shared_ptr<const Mirror> after = reshaped(mirror_, result);
  const Mesh mesh = after ? after->mesh(placed_points(result)) : Mesh();
  MeshModel* holder = holder_;
  if (!holder)
    holder = &ResultLayers(document, layer, finding_filter).add_mirror(mirror_, mirror_->mesh());
  if (const auto rigid = result.statistics.find("matrix"); rigid != result.statistics.end())
    move_results(document, layer, std::get<Eigen::MatrixXd>(rigid->second));
  if (after && is_result_of(*holder, layer) && holder->cm.Tr == layer.cm.Tr)
    draw_mirror(*holder, after, mesh, after == mirror_ ? nullptr : mirror_);
  return *holder;
}

}  // namespace symsurf::meshlab
