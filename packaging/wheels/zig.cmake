# Compiles with Clang of the Python package ziglang, which has the C and C++ libraries of many systems, for
# SYMSURF_TARGET: x86_64-linux-gnu.2.17, aarch64-linux-gnu.2.17, x86_64-windows-gnu, aarch64-macos.11.0,
# x86_64-macos.11.0. .ci/wheels makes the programs c++, cc, ar and ranlib for it in ZIG_PROGRAMS, and puts
# libraries of headers into LIBRARIES.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES SYMSURF_TARGET ZIG_PROGRAMS LIBRARIES)
if(SYMSURF_TARGET MATCHES "windows")
  set(CMAKE_SYSTEM_NAME Windows)
  set(CMAKE_RC_COMPILER ${ZIG_PROGRAMS}/rc)
elseif(SYMSURF_TARGET MATCHES "macos")
  set(CMAKE_SYSTEM_NAME Darwin)
  set(CMAKE_INSTALL_NAME_TOOL ${ZIG_PROGRAMS}/install_name_tool)
else()
  set(CMAKE_SYSTEM_NAME Linux)
endif()
string(REGEX MATCH "^[^-]*" CMAKE_SYSTEM_PROCESSOR ${SYMSURF_TARGET})
set(CMAKE_C_COMPILER ${ZIG_PROGRAMS}/cc)
set(CMAKE_CXX_COMPILER ${ZIG_PROGRAMS}/c++)
set(CMAKE_C_FLAGS_INIT -g0)  # zig writes what debuggers need otherwise: a quarter more time
set(CMAKE_CXX_FLAGS_INIT -g0)
set(CMAKE_AR ${ZIG_PROGRAMS}/ar)
set(CMAKE_RANLIB ${ZIG_PROGRAMS}/ranlib)
# Headers and libraries of this system are not the target's.
set(CMAKE_FIND_ROOT_PATH ${LIBRARIES})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
