# Builds the VTK module, its Python wrapping and, on ParaView's VTK, the plugin.
enable_language(C)  # VTK looks for MPI's C library
include(GNUInstallDirs)
option(BUILD_SHARED_LIBS "Build shared VTK modules" ON)
option(SYMSURF_VTK_PYTHON "Wrap the VTK module for Python" ON)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR})
if(NOT SKBUILD)
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)  # a VTK that stands elsewhere is found at run time too
endif()

if(SYMSURF_PARAVIEW)
  find_package(ParaView REQUIRED
    COMPONENTS RemotingCore RemotingServerManager RemotingViews WrapClientServer ProcessXML)
  message(STATUS "symsurf: ParaView ${ParaView_VERSION}")
endif()
find_package(VTK REQUIRED
  COMPONENTS CommonCore CommonDataModel CommonExecutionModel FiltersCore FiltersGeometry
             ParallelCore
  OPTIONAL_COMPONENTS ParallelMPI WrappingPythonCore Python)
message(STATUS "symsurf: VTK ${VTK_VERSION}")

# The titles of the core's operations: a filter and a proxy each.
set(symsurf_operations MirrorAsymmetry MirrorCorrespondences MirrorAlignment MirrorCompletion
    MirrorSymmetrization MirrorStraightening MirrorRemeshing MirrorCut MirrorTransfer
    MirrorIllumination)

add_executable(symsurf_generate)
file(GLOB generate_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/generate/*.cpp)
target_sources(symsurf_generate PRIVATE ${generate_sources})
set_target_properties(symsurf_generate PROPERTIES UNITY_BUILD ON)
target_link_libraries(symsurf_generate PRIVATE symsurf::core)

# Makes OUTPUT from the core's description of what CLASS can do; see generate/main.cpp.
function(symsurf_generate class output)
  add_custom_command(OUTPUT ${output}
    COMMAND symsurf_generate ${class} ${output} ${ARGN}
    DEPENDS symsurf_generate ${ARGN}
    COMMENT "Describing ${class}" VERBATIM)
endfunction()

set(module_files ${CMAKE_CURRENT_LIST_DIR}/vtk.module)
set(requested_modules symsurf::Filters)
if(SYMSURF_PARAVIEW)
  list(APPEND module_files ${CMAKE_CURRENT_LIST_DIR}/paraview/server_manager/vtk.module)
  list(APPEND requested_modules symsurf::ServerManager)
endif()
vtk_module_scan(MODULE_FILES ${module_files}
  REQUEST_MODULES ${requested_modules} PROVIDES_MODULES symsurf_modules HIDE_MODULES_FROM_CACHE ON)
vtk_module_build(MODULES ${symsurf_modules}
  PACKAGE symsurf-filters INSTALL_EXPORT symsurf-filters INSTALL_HEADERS ON
  HEADERS_DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/symsurf-filters
  CMAKE_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/symsurf-filters)
# The VTK that it was built with, and the core where the module is a static library.
set(core_dependency)
if(SYMSURF_PARAVIEW)
  export(EXPORT symsurf NAMESPACE symsurf::)  # VTK exports what it builds, which names the core
  set(core_dependency "find_dependency(symsurf HINTS \${CMAKE_CURRENT_LIST_DIR}/../symsurf)\n")
endif()
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/symsurf-filters-config.cmake
  "include(CMakeFindDependencyMacro)\n"
  "if(NOT VTK_DIR)\n"
  "  set(VTK_DIR \"${VTK_DIR}\")\n"
  "endif()\n"
  "${core_dependency}"
  "find_dependency(VTK COMPONENTS CommonCore CommonDataModel CommonExecutionModel\n"
  "  OPTIONAL_COMPONENTS ParallelMPI)\n"
  "include(\${CMAKE_CURRENT_LIST_DIR}/symsurf-filters-targets.cmake)\n")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/symsurf-filters-config.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/symsurf-filters)

if(SYMSURF_VTK_PYTHON)
  find_package(Python3 REQUIRED COMPONENTS Interpreter Development)
  set(symsurf_python_folder
    ${CMAKE_INSTALL_LIBDIR}/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/site-packages)
  if(SKBUILD)
    set(symsurf_python_folder .)  # in a wheel
  endif()
  set(CMAKE_UNITY_BUILD ON)  # of a target whose name is VTK's affair
  vtk_module_wrap_python(MODULES symsurf::Filters PYTHON_PACKAGE symsurf_filters
    MODULE_DESTINATION ${symsurf_python_folder} LIBRARY_DESTINATION ${CMAKE_INSTALL_LIBDIR}
    INSTALL_HEADERS OFF TARGET symsurf::filters_python)
  unset(CMAKE_UNITY_BUILD)
endif()

if(SYMSURF_PARAVIEW)
  paraview_plugin_scan(PLUGIN_FILES ${CMAKE_CURRENT_LIST_DIR}/paraview/paraview.plugin
    PROVIDES_PLUGINS symsurf_plugins ENABLE_BY_DEFAULT ON HIDE_PLUGINS_FROM_CACHE ON)
  paraview_plugin_build(PLUGINS ${symsurf_plugins} PLUGINS_FILE_NAME symsurf.plugins.xml
    RUNTIME_DESTINATION ${CMAKE_INSTALL_BINDIR} LIBRARY_DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY_SUBDIRECTORY paraview-${ParaView_VERSION_MAJOR}.${ParaView_VERSION_MINOR}/plugins)
endif()
