# symsurf_python_module(TARGET): the module's sources, options and libraries; which Python, its caller says.
file(GLOB symsurf_python_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/src/*.cpp)

function(symsurf_python_module target)
  target_sources(${target} PRIVATE ${symsurf_python_sources})
  # Two batches of sources: most of what they compile is pybind11's.
  set_target_properties(${target} PROPERTIES OUTPUT_NAME _core CXX_VISIBILITY_PRESET hidden
    UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 7)
  # -O1: it hands arrays over and computes nothing.
  target_compile_options(${target} PRIVATE ${symsurf_warnings} $<IF:$<CXX_COMPILER_ID:MSVC>,/O1,-O1>)
  target_compile_definitions(${target} PRIVATE SYMSURF_VERSION="${symsurf_VERSION}")
  target_link_libraries(${target} PRIVATE symsurf::core)
endfunction()
