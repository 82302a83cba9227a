# SPDX-License-Identifier: Apache-2.0

# libc++ for WASI, which knows one thread and no file system: `include` adds the types of threads and paths, and
# bindings/browser/{one_thread,path,file_system,posix}.cpp their functions.
add_compile_options(-msimd128 -mbulk-memory -fignore-exceptions -nostdinc++
                    "SHELL:-isystem ${CMAKE_CURRENT_LIST_DIR}/include" "SHELL:-isystem /usr/include/wasm32-wasi/c++/v1")
add_link_options(-L/usr/lib/wasm32-wasi -Wl,--strip-all -Wl,-z,stack-size=1048576 -Wl,--wrap=fcntl)
set(CMAKE_EXECUTABLE_SUFFIX .wasm)
set(CMAKE_CXX_COMPILE_OPTIONS_PIC)  # one module, which nothing else is linked with

# The libraries of others as headers alone: Debian's are for its own processors.
foreach(library fmt::fmt fmt::fmt-header-only hwy::hwy Eigen3::Eigen nlohmann_json::nlohmann_json tomlplusplus::tomlplusplus
        Boost::headers)
  string(REPLACE :: _ target others_${library})
  add_library(${target} INTERFACE)
  add_library(${library} ALIAS ${target})
endforeach()
target_compile_definitions(others_fmt_fmt INTERFACE FMT_HEADER_ONLY)
target_compile_definitions(others_fmt_fmt-header-only INTERFACE FMT_HEADER_ONLY)
target_compile_definitions(others_tomlplusplus_tomlplusplus INTERFACE TOML_EXCEPTIONS=0)
target_include_directories(others_Eigen3_Eigen SYSTEM INTERFACE /usr/include/eigen3)

# Sources that need ports, sockets, or more than one thread.
set(DERMIS_LEFT_OUT "calibration/(parallel|guided/guide_fitter)\\.cpp|devices/(byte_stream|descriptor_stream|serial_.*|frame_queue|recorder)\\.cpp")
# A size has 32 bits there, and numbers of 64 bits that are within bounds become one. Not each loop becomes a vector.
target_compile_options(dermis_build_flags INTERFACE -Wno-shorten-64-to-32 -Wno-c++11-narrowing -Wno-pass-failed)
