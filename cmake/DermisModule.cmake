# SPDX-License-Identifier: Apache-2.0

# Every target of the project: C++20, warnings are errors, the sanitizers of the preset.
add_library(dermis_build_flags INTERFACE)
target_compile_features(dermis_build_flags INTERFACE cxx_std_20)
target_compile_options(dermis_build_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Werror)
# Every x86 processor since 2008 has at least SSE4: one instruction set less to compile each kernel for. Under the
# sanitizers the portable kernels have its four lanes, and AVX2 stands for what is wider. Vectors of SVE have no size that
# an array of them could have: arm64 has NEON.
set(DERMIS_INSTRUCTION_SETS_LEFT_OUT HWY_SSSE3)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
  set(DERMIS_INSTRUCTION_SETS_LEFT_OUT "(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
elseif(DERMIS_SANITIZE)
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
  target_compile_definitions(dermis_build_flags INTERFACE _GLIBCXX_ASSERTIONS)
endif()

# With DERMIS_SHARED, src and viewer are one library, which the command and the Python package share. Calls within it are as
# quick as in a program. Its name has the version, so that none takes that of another.
if(DERMIS_SHARED)
  set(DERMIS_SYMBOLS ${PROJECT_SOURCE_DIR}/cmake/shared_symbols.map)
  add_library(dermis_shared SHARED)
  set_target_properties(dermis_shared PROPERTIES OUTPUT_NAME dermis-${PROJECT_VERSION} LINKER_LANGUAGE CXX LINK_DEPENDS ${DERMIS_SYMBOLS}
                                                 LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
                                                 BUILD_RPATH "$ORIGIN")  # where the plugins are
  target_link_options(dermis_shared PRIVATE -Wl,--version-script=${DERMIS_SYMBOLS} -Wl,-Bsymbolic-functions
                                            -Wl,-z,now -Wl,--no-undefined)
endif()

# name_library(<target> <what it links>): it is dermis::<name> to the others. With DERMIS_SHARED, that is the one library.
function(name_library target)
  string(REPLACE dermis_ dermis:: name ${target})
  if(NOT DERMIS_SHARED)
    add_library(${name} ALIAS ${target})
    return()
  endif()
  target_sources(dermis_shared PRIVATE $<TARGET_OBJECTS:${target}>)
  target_include_directories(dermis_shared INTERFACE $<TARGET_PROPERTY:${target},INTERFACE_INCLUDE_DIRECTORIES>)
  target_link_libraries(dermis_shared PRIVATE ${ARGN})
  add_library(${name} ALIAS dermis_shared)
endfunction()

# For loops with DERMIS_PROCESSOR_CLONES: a choice or a square root becomes a vector only where a comparison need not trap
# nor a root set errno; a sum, only where "omp simd" allows any order; a product and a sum are rounded apart everywhere.
set(DERMIS_VECTOR_OPTIONS -fopenmp-simd -fno-trapping-math -fno-math-errno -ffp-contract=off)

# compile_together(<target> [<sources that stay alone>]): with DERMIS_UNITY_BUILD, its sources in batches.
function(compile_together target)
  if(NOT DERMIS_UNITY_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE apart)
  list(REMOVE_ITEM sources ${apart})
  execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/batches.py ${sources}
                  WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE batches COMMAND_ERROR_IS_FATAL ANY)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source batch IN ZIP_LISTS sources batches)
    if(NOT batch STREQUAL "alone")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP batch_${batch})
    endif()
  endforeach()
endfunction()

# keep_inside(<plugin>): of static libraries it keeps what it uses, and shows none of it.
function(keep_inside plugin)
  target_link_options(${plugin} PRIVATE -Wl,--exclude-libs,ALL -Wl,--gc-sections -Wl,--as-needed)
endfunction()

# checked_modules(<variable> <targets>): with those of checked libraries in the place of their modules.
function(checked_modules variable)
  set(targets)
  foreach(target ${ARGN})
    string(REPLACE :: _ name ${target})
    if(TARGET ${name}_checked)
      set(target ${name}_checked)
    endif()
    list(APPEND targets ${target})
  endforeach()
  set(${variable} ${targets} PARENT_SCOPE)
endfunction()

# dermis_module(<name> [NUMERICS [PARSERS <sources>]] DEPENDS <modules> PRIVATE <third-party targets>): the static library
# dermis::<name> from all sources of this folder, with the public headers of include/dermis.
#
# NUMERICS read no byte from outside but in their PARSERS, and depend on each other and `files` alone.
# With DERMIS_CHECK_NUMERICS, their tests run on dermis_<name>_checked: with assertions, which cost a release a quarter.
# With DERMIS_NUMERICS_FROM, those libraries are taken from that tree, and of the module only the parsers are compiled.
function(dermis_module name)
  cmake_parse_arguments(MODULE "NUMERICS" "" "PARSERS;DEPENDS;PRIVATE" ${ARGN})
  list(TRANSFORM MODULE_DEPENDS PREPEND dermis_)
  if(MODULE_NUMERICS)
    set_property(GLOBAL APPEND PROPERTY DERMIS_NUMERICS ${name})
    set_property(GLOBAL PROPERTY DERMIS_PARSERS_OF_${name} ${MODULE_PARSERS})
  endif()

  if(MODULE_NUMERICS AND DERMIS_NUMERICS_FROM)
    borrow_library(dermis_${name})
  else()
    build_library(dermis_${name} ${MODULE_DEPENDS})
    set_target_properties(dermis_${name} PROPERTIES EXPORT_NAME ${name})
    set_property(GLOBAL APPEND PROPERTY DERMIS_MODULES dermis_${name})
    if(CMAKE_BUILD_TYPE STREQUAL Release AND name IN_LIST DERMIS_CALCULATES_LITTLE)
      target_compile_options(dermis_${name} PRIVATE -O1)
    endif()
    if(DERMIS_SANITIZE AND (MODULE_NUMERICS OR name IN_LIST DERMIS_AWAITED))
      target_compile_options(dermis_${name} PRIVATE -O1)
    endif()
  endif()
  name_library(dermis_${name} ${MODULE_PRIVATE})

  if(MODULE_NUMERICS AND DERMIS_CHECK_NUMERICS)
    checked_modules(depends ${MODULE_DEPENDS})
    build_library(dermis_${name}_checked ${depends})
    # The release warns; beside the assertions of the standard library, g++ 12 has false warnings.
    target_compile_options(dermis_${name}_checked PRIVATE -w -O2 -UNDEBUG -D_GLIBCXX_ASSERTIONS)
    add_dependencies(dermis_checked_numerics dermis_${name}_checked)
  endif()
endfunction()
add_custom_target(dermis_checked_numerics)

# A release spends its time in the other modules: these take a third less to compile so.
set(DERMIS_CALCULATES_LITTLE health forces report serve)

# Under the sanitizers, code is compiled twice as fast without optimisation; but the tests wait for numerics and for these.
set(DERMIS_AWAITED devices)

# build_library(<target> <depends>) and borrow_library(<target>): what dermis_module() was asked for.
function(build_library target)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  if(DERMIS_LEFT_OUT)
    list(FILTER sources EXCLUDE REGEX ${DERMIS_LEFT_OUT})
  endif()
  add_library(${target} STATIC ${sources})
  compile_together(${target} ${MODULE_PARSERS})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  set_headers(${target} PUBLIC)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  # Of headers alone, nothing is left to be linked by who uses an installed dermis.
  list(TRANSFORM MODULE_PRIVATE REPLACE "^(Boost::headers|Eigen3::Eigen|nlohmann_json::nlohmann_json|fmt::fmt-header-only)$"
       "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(${target} PUBLIC ${ARGN} PRIVATE $<BUILD_INTERFACE:dermis_build_flags> ${MODULE_PRIVATE})
endfunction()

function(borrow_library target)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE folder)
  add_library(${target} STATIC IMPORTED GLOBAL)
  set_target_properties(${target} PROPERTIES
                        IMPORTED_LOCATION ${DERMIS_NUMERICS_FROM}/${folder}/lib${target}_checked.a)
  set_headers(${target} INTERFACE)
  target_link_libraries(${target} INTERFACE ${MODULE_DEPENDS})
  foreach(library ${MODULE_PRIVATE})
    target_link_libraries(${target} INTERFACE $<LINK_ONLY:${library}>)
  endforeach()
  if(MODULE_PARSERS)
    # Objects come before libraries, so nothing asks for the parsers of the borrowed one.
    add_library(${target}_parsers OBJECT ${MODULE_PARSERS})
    set_target_properties(${target}_parsers PROPERTIES POSITION_INDEPENDENT_CODE ON)
    set_headers(${target}_parsers PUBLIC)
    target_include_directories(${target}_parsers PRIVATE ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(${target}_parsers PUBLIC ${MODULE_DEPENDS} PRIVATE dermis_build_flags ${MODULE_PRIVATE})
    target_link_libraries(${target} INTERFACE $<TARGET_OBJECTS:${target}_parsers>)
  endif()
endfunction()

function(set_headers target scope)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                                                $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()
