# SPDX-License-Identifier: Apache-2.0

# Every target of the project: C++20, warnings are errors, the sanitizers of the preset.
add_library(dermis_build_flags INTERFACE)
target_compile_features(dermis_build_flags INTERFACE cxx_std_20)
target_compile_options(dermis_build_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Werror)
# Every x86 processor since 2008 has at least SSE4: one instruction set less to compile each kernel for. Under the
# sanitizers the portable kernels have its four lanes, and AVX2 stands for what is wider.
set(DERMIS_INSTRUCTION_SETS_LEFT_OUT HWY_SSSE3)
if(DERMIS_SANITIZE)
  set(DERMIS_INSTRUCTION_SETS_LEFT_OUT "(HWY_SSSE3|HWY_SSE4|HWY_AVX3)")
endif()
target_compile_definitions(dermis_build_flags INTERFACE HWY_DISABLED_TARGETS=${DERMIS_INSTRUCTION_SETS_LEFT_OUT})
# __FILE__ begins at this folder: the same in every clone, which ccache needs to find what another has compiled.
target_compile_options(dermis_build_flags INTERFACE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # g++ 12 reports std::string operator+ as overlapping (GCC bug 105651), and in sources that are compiled together every
  # member of a type of an unnamed namespace.
  target_compile_options(dermis_build_flags INTERFACE -Wno-restrict -Wno-subobject-linkage)
endif()
if(DERMIS_SANITIZE)
  target_compile_options(dermis_build_flags INTERFACE -fsanitize=${DERMIS_SANITIZE} -fno-sanitize-recover=all
                                                      -fno-omit-frame-pointer)
  target_link_options(dermis_build_flags INTERFACE -fsanitize=${DERMIS_SANITIZE})
endif()

# Under the sanitizers, code is compiled three times as fast without optimisation. Tests wait for the modules, but for those
# which only bring together what others have calculated.
set(DERMIS_NEVER_AWAITED health live report serve stream)

# compile_together(<target>): with DERMIS_UNITY_BUILD, its sources in batches.
function(compile_together target)
  if(NOT DERMIS_UNITY_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/batches.py ${sources}
                  WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE batches COMMAND_ERROR_IS_FATAL ANY)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source batch IN ZIP_LISTS sources batches)
    if(NOT batch STREQUAL alone)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP batch_${batch})
    endif()
  endforeach()
endfunction()

# dermis_module(<name> DEPENDS <modules> PRIVATE <third-party targets>): the static library dermis::<name> from all
# sources of src/<name>, with the public headers of include/dermis/<name>.
function(dermis_module name)
  cmake_parse_arguments(MODULE "" "" "DEPENDS;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  add_library(dermis_${name} STATIC ${sources})
  compile_together(dermis_${name})
  add_library(dermis::${name} ALIAS dermis_${name})
  set_target_properties(dermis_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(dermis_${name} PUBLIC cxx_std_20)
  if(DERMIS_SANITIZE AND NOT name IN_LIST DERMIS_NEVER_AWAITED)
    target_compile_options(dermis_${name} PRIVATE -O1)
  endif()
  target_include_directories(dermis_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                   $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                                                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                                            PRIVATE ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM MODULE_DEPENDS PREPEND dermis_)
  target_link_libraries(dermis_${name} PUBLIC ${MODULE_DEPENDS}
                        PRIVATE $<BUILD_INTERFACE:dermis_build_flags> ${MODULE_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY DERMIS_MODULES dermis_${name})
endfunction()
