# For Debian's paraview-dev 6.1, which lists ParaView's Python modules by names that their package
# does not give them, so that find_package(ParaView) stops. Nothing here links with them; those that
# are declared already it takes for found.
#
#   cmake -DCMAKE_PROJECT_symsurf_INCLUDE=vtk_filters/debian_paraview.cmake -DSYMSURF_PARAVIEW=ON ...
function(symsurf_declare_paraview_python)
  file(GLOB lists /usr/lib/*/cmake/paraview-*/ParaViewPython*-targets.cmake)
  foreach(list IN LISTS lists)
    file(STRINGS ${list} declarations REGEX "^add_library\\(")
    foreach(declaration IN LISTS declarations)
      string(REGEX MATCH "[A-Za-z0-9_]+::[A-Za-z0-9_]+" target ${declaration})
      add_library(${target} MODULE IMPORTED)
    endforeach()
  endforeach()
endfunction()

symsurf_declare_paraview_python()
