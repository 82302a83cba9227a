# SPDX-License-Identifier: Apache-2.0
# cmake --toolchain packaging/wheels/toolchain.cmake -D DERMIS_WHEEL_ARCH=x86_64|aarch64: g++ 12 for glibc 2.31 or later, with
# the root that packaging/wheels/prefix makes.
set(DERMIS_WHEEL_ARCH x86_64 CACHE STRING "Processor that wheels are for")
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES DERMIS_WHEEL_ARCH)
if(DEFINED ENV{XDG_CACHE_HOME})
  set(root $ENV{XDG_CACHE_HOME}/dermis/wheels/${DERMIS_WHEEL_ARCH})
else()
  set(root $ENV{HOME}/.cache/dermis/wheels/${DERMIS_WHEEL_ARCH})
endif()

set(CMAKE_C_COMPILER ${root}/bin/gcc)
set(CMAKE_CXX_COMPILER ${root}/bin/g++)
set(CMAKE_LIBRARY_ARCHITECTURE ${DERMIS_WHEEL_ARCH}-linux-gnu)
foreach(tool AR RANLIB STRIP OBJCOPY NM)
  string(TOLOWER ${tool} name)
  set(CMAKE_${tool} /usr/bin/${CMAKE_LIBRARY_ARCHITECTURE}-${name})
endforeach()

cmake_host_system_information(RESULT host QUERY OS_PLATFORM)
if(NOT host STREQUAL DERMIS_WHEEL_ARCH)
  set(CMAKE_SYSTEM_NAME Linux)
  set(CMAKE_SYSTEM_PROCESSOR ${DERMIS_WHEEL_ARCH})
  set(CMAKE_CROSSCOMPILING_EMULATOR ${root}/bin/run)
endif()

# Of the static library of C++, each shared object keeps what it uses.
foreach(kind EXE MODULE SHARED)
  set(CMAKE_${kind}_LINKER_FLAGS_INIT -Wl,--gc-sections)
endforeach()

set(CMAKE_SYSROOT ${root})
set(CMAKE_FIND_ROOT_PATH ${root})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(kind LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${root})
set(ENV{PKG_CONFIG_LIBDIR} ${root}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/pkgconfig:${root}/usr/share/pkgconfig)
set(PKG_CONFIG_ARGN --static)
