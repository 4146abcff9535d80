"""Weights, shape keys and colours of one side, carried to the other."""

import json

import bpy
import numpy as np
import pytest
from heads import coordinates, head, in_scene, partners, plane_of, values

TINY = 2e-6


def _weights(shape, name):
    group = shape.vertex_groups[name].index
    made = np.zeros(len(shape.data.vertices))
    for vertex in shape.data.vertices:
        for each in vertex.groups:
            if each.group == group:
                made[vertex.index] = each.weight
    return made


def _add_weights(shape, name, weights):
    group = shape.vertex_groups.new(name=name)
    for index in np.flatnonzero(weights).tolist():
        group.add([index], weights[index], "REPLACE")


def _painted(points):
    """Weights of the side x > 0 of the object."""
    return np.clip(points[:, 0], 0, 1)


@pytest.fixture
def side():
    """Of the mirror of a head, where its x is above 0: signed distances say which name that has."""
    shape, _ = head()
    bpy.ops.symsurf.detect(method="plane")
    normal = json.loads(shape.symsurf_mirror["symsurf_mirror"])["numbers"]["normal"]
    return "positive" if np.dot(normal, plane_of()[0]) > 0 else "negative"


@pytest.fixture
def shape(side):
    return bpy.context.active_object


@pytest.fixture
def partner():
    return partners(40, 24)


def test_weights_go_to_the_group_of_the_other_side(shape, partner, side):
    weights = _painted(coordinates(shape))
    _add_weights(shape, "arm.L", weights)
    assert bpy.ops.symsurf.transfer(side=side) == {"FINISHED"}
    assert np.abs(_weights(shape, "arm.L") - weights).max() < TINY
    assert np.abs(_weights(shape, "arm.R") - weights[partner]).max() < TINY


def test_weights_of_no_side_are_mirrored_in_their_group(shape, partner, side):
    weights = _painted(coordinates(shape))
    _add_weights(shape, "head", weights)
    _add_weights(shape, "hand.R", weights)
    bpy.ops.symsurf.transfer(side=side, flip_names=False)
    for name in ("head", "hand.R"):
        assert np.abs(_weights(shape, name) - (weights + weights[partner])).max() < TINY
    assert "hand.L" not in shape.vertex_groups


def test_weights_that_the_other_side_lacks_are_removed(shape, partner, side):
    weights = _painted(coordinates(shape))
    _add_weights(shape, "head", 0.5 * weights[partner])
    bpy.ops.symsurf.transfer(side=side)
    assert _weights(shape, "head").max() == 0


def _add_key(shape, name, offsets):
    key = shape.shape_key_add(name=name, from_mix=False)
    key.data.foreach_set("co", (coordinates(shape) + offsets).astype(np.float32).ravel())


def _offsets(shape, name):
    made = np.empty(3 * len(shape.data.vertices), np.float32)
    shape.data.shape_keys.key_blocks[name].data.foreach_get("co", made)
    return made.reshape(-1, 3) - coordinates(shape)


def test_shape_keys_are_mirrored(shape, partner, side):
    shape.shape_key_add(name="Basis")
    points = coordinates(shape)
    smile = _painted(points)[:, None] * (0.1, 0.2, -0.3)
    _add_key(shape, "smile", smile)
    _add_key(shape, "blink.L", smile)
    bpy.ops.symsurf.transfer(side=side)
    image = smile[partner] * (-1, 1, 1)
    assert np.abs(_offsets(shape, "smile") - (smile + image)).max() < TINY
    assert np.abs(_offsets(shape, "blink.L") - smile).max() < TINY
    assert np.abs(_offsets(shape, "blink.R") - image).max() < TINY
    assert (coordinates(shape) == points).all()


def test_colours_are_carried_and_may_stay(shape, partner, side):
    painted = np.column_stack([*3 * [_painted(coordinates(shape))], np.ones(len(partner))])
    layer = shape.data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    layer.data.foreach_set("color", painted.ravel())
    bpy.ops.symsurf.transfer(side=side, attributes=False)
    assert np.abs(values(shape, "Paint", "color", 4) - painted).max() < TINY
    bpy.ops.symsurf.transfer(side=side)
    carried = values(shape, "Paint", "color", 4)
    assert np.abs(carried[:, 0] - (painted + painted[partner])[:, 0]).max() < TINY


def test_moving_the_basis_moves_shape_keys_with_it(shape, partner):
    shape.shape_key_add(name="Basis")
    offsets = np.random.default_rng(3).normal(size=coordinates(shape).shape) * 0.01
    _add_key(shape, "wobble", offsets)
    before = in_scene(shape)
    bpy.ops.symsurf.symmetrize(strength=0.5)
    assert np.abs(_offsets(shape, "wobble") - offsets).max() < TINY
    bpy.ops.symsurf.align()
    matrix = np.array(shape.matrix_world)
    assert (matrix == np.eye(4)).all()
    lengths = np.linalg.norm(_offsets(shape, "wobble"), axis=1)
    assert np.abs(lengths - 2 * np.linalg.norm(offsets, axis=1)).max() < 2 * TINY  # its scale
    assert np.ptp(before) > 0


@pytest.mark.parametrize("name", ["cut", "symmetrize", "complete", "remesh"])
def test_new_vertices_have_weights_between_those_of_the_old(shape, name):
    points = coordinates(shape)
    _add_weights(shape, "up", np.clip(points[:, 2] * 0.3 + 0.5, 0, 1))
    options = {"triangles": "mirrored"} if name == "symmetrize" else {}
    getattr(bpy.ops.symsurf, name)(**options)
    points = coordinates(shape)
    off = np.abs(_weights(shape, "up") - np.clip(points[:, 2] * 0.3 + 0.5, 0, 1))
    assert off[np.abs(points[:, 0]) > 1e-5].max() < 0.02  # within a cap they are those of its rim
