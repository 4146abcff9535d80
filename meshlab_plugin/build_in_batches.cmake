# Included by MeshLab's project(MeshLab): compiles its libraries in batches of sources, which halves
# the time. Left out is what includes a header without a guard, or OpenGL in an order of its own.
set(CMAKE_UNITY_BUILD ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 10)
cmake_language(DEFER CALL set_source_files_properties
  src/common/ml_shared_data_context/ml_shared_data_context.cpp
  DIRECTORY src/common PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
cmake_language(DEFER CALL set_target_properties meshlab PROPERTIES UNITY_BUILD OFF)
