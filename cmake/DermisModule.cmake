# SPDX-License-Identifier: Apache-2.0

# Every target of the project: C++20, warnings are errors, the sanitizers of the preset.
add_library(dermis_build_flags INTERFACE)
target_compile_features(dermis_build_flags INTERFACE cxx_std_20)
target_compile_options(dermis_build_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # g++ 12 reports std::string operator+ as overlapping (GCC bug 105651).
  target_compile_options(dermis_build_flags INTERFACE -Wno-restrict)
endif()
if(DERMIS_SANITIZE)
  target_compile_options(dermis_build_flags INTERFACE -fsanitize=${DERMIS_SANITIZE} -fno-sanitize-recover=all
                                                      -fno-omit-frame-pointer)
  target_link_options(dermis_build_flags INTERFACE -fsanitize=${DERMIS_SANITIZE})
endif()

# dermis_module(<name> DEPENDS <modules> PRIVATE <third-party targets>): the static library dermis::<name> from all
# sources of src/<name>, with the public headers of include/dermis/<name>.
function(dermis_module name)
  cmake_parse_arguments(MODULE "" "" "DEPENDS;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  add_library(dermis_${name} STATIC ${sources})
  add_library(dermis::${name} ALIAS dermis_${name})
  set_target_properties(dermis_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(dermis_${name} PUBLIC cxx_std_20)
  target_include_directories(dermis_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                   $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                                                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                                            PRIVATE ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM MODULE_DEPENDS PREPEND dermis_)
  target_link_libraries(dermis_${name} PUBLIC ${MODULE_DEPENDS}
                        PRIVATE $<BUILD_INTERFACE:dermis_build_flags> ${MODULE_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY DERMIS_MODULES dermis_${name})
endfunction()
