"""Who finds planes: symsurf, and what else can be installed from Python's registry. Each takes points
(n, 3) whose diagonal is 200 and gives a plane."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import open3d
from accuracy.icp import multi_start_icp
from accuracy.poses import Points, diagonal
from pyclarcs.coarse import coarse_symmetry
from pyclarcs.fine import em_icp_sym, em_icp_sym_corres
from pyclarcs.principal_axes import best_principal_axis_plane
from pyclarcs.symmetry import SymmetryPlane

import symsurf
from symsurf import Plane

registration = open3d.pipelines.registration


def symsurf_plane(points: Points) -> Plane:
    return symsurf.detect(points, "plane", threads=1).mirror


def symsurf_auto(points: Points) -> Plane | None:
    """None where it is no plane that it finds."""
    mirror = symsurf.detect(points, "auto", threads=1).mirror
    return mirror if isinstance(mirror, Plane) else None


def symsurf_icp(points: Points) -> Plane:
    return symsurf.detect(points, "plane_icp", threads=1).mirror


def symsurf_svd(points: Points) -> Plane:
    return symsurf.detect(points, "plane_svd", threads=1).mirror


def symsurf_hruda(points: Points) -> Plane:
    return symsurf.detect(points, "plane_hruda", threads=1).mirror


def principal_axes(points: Points) -> Plane:
    """Of the planes through the centroid across the principal axes the one with the least
    distances from the images to the points."""
    return _plane(best_principal_axis_plane(points))


def pyclarcs(points: Points) -> Plane:
    """What its command `symplane` does (Combes et al. 2008): the best principal axis, trimmed ICP,
    EM-ICP, EM-ICP with symmetric correspondences. Its lengths are millimetres of a skull."""
    plane = coarse_symmetry(points, best_principal_axis_plane(points), seed=0)
    return _plane(em_icp_sym_corres(points, em_icp_sym(points, plane)))


def _plane(found: SymmetryPlane) -> Plane:
    return Plane(found.n, -found.d)


def reflective_icp(points: Points) -> Plane:
    """Iterative closest points under a reflection, from 33 starts (tests/accuracy/icp.py)."""
    return multi_start_icp(points, np.random.default_rng(0))


def reflect_and_register(points: Points) -> Plane:
    """The image in any plane is registered with the points by features and RANSAC, then by ICP to
    planes, as Cicconet et al. (2017) do, with Open3D."""
    open3d.utility.random.seed(0)
    voxel = 0.03 * diagonal(points)
    mirrored = points * (-1, 1, 1)
    coarse = [_described(each, voxel) for each in (mirrored, points)]
    (source, source_features), (target, target_features) = coarse
    rough = registration.registration_ransac_based_on_feature_matching(
        source, target, source_features, target_features, True, 1.5 * voxel,
        registration.TransformationEstimationPointToPoint(False), 3,
        [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
         registration.CorrespondenceCheckerBasedOnDistance(1.5 * voxel)],
        registration.RANSACConvergenceCriteria(100000, 0.999),
    )  # fmt: skip
    fine = registration.registration_icp(
        _cloud(mirrored, voxel), _cloud(points, voxel), voxel, rough.transformation,
        registration.TransformationEstimationPointToPlane(),
    )  # fmt: skip
    turn = fine.transformation[:3, :3] @ np.diag((-1, 1, 1))
    # A reflection up to errors: its normal is what it turns round.
    normal = np.linalg.eigh(turn + turn.T)[1][:, 0]
    return Plane(normal, -normal @ fine.transformation[:3, 3] / 2)


def _cloud(points: Points, voxel: float) -> open3d.geometry.PointCloud:
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamHybrid(2 * voxel, 30))
    return cloud


def _described(
    points: Points, voxel: float
) -> tuple[open3d.geometry.PointCloud, registration.Feature]:
    cloud = _cloud(points, voxel).voxel_down_sample(voxel)
    cloud.orient_normals_towards_camera_location(cloud.get_center())
    search = open3d.geometry.KDTreeSearchParamHybrid(5 * voxel, 100)
    return cloud, registration.compute_fpfh_feature(cloud, search)


DETECTORS: dict[str, Callable[[Points], Plane | None]] = {
    "symsurf `plane`": symsurf_plane,
    "symsurf `auto`": symsurf_auto,
    "symsurf `plane_icp`": symsurf_icp,
    "symsurf `plane_svd`": symsurf_svd,
    "symsurf `plane_hruda`": symsurf_hruda,
    "principal axes": principal_axes,
    "pyclarcs": pyclarcs,
    "reflective ICP": reflective_icp,
    "Open3D": reflect_and_register,
}
