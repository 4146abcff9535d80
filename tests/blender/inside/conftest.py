"""Tests that run in Blender's own Python, with the extension installed from its zip."""

import os

import bpy
import pytest


def pytest_addoption(parser):
    parser.addoption("--zip", help="the extension")


def pytest_configure(config):
    # Before the tests are read, which import the wheel inside it.
    bpy.ops.extensions.package_install_files(
        filepath=config.getoption("--zip"), repo="user_default", enable_on_install=True
    )


@pytest.fixture(autouse=True)
def empty_scene():
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for data in (bpy.data.objects, bpy.data.meshes):
        for each in list(data):
            data.remove(each)


def pytest_sessionfinish(session, exitstatus):
    session.config.exit_status = int(exitstatus)


def pytest_unconfigure(config):
    import addon_utils  # which bpy brings

    addon_utils.disable("bl_ext.user_default.symsurf")  # raises nothing: what failed is printed
    # As a module Blender may wait for ever when the interpreter ends.
    config.get_terminal_writer().flush()
    os._exit(getattr(config, "exit_status", 1))
