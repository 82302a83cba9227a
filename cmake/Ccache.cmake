# SPDX-License-Identifier: Apache-2.0

# What was compiled before is taken from ccache, where it is installed: also what another clone has compiled, as paths
# below this folder count as relative and the folder itself does not count.
find_program(DERMIS_CCACHE ccache)
mark_as_advanced(DERMIS_CCACHE)
if(DERMIS_CCACHE)
  foreach(language C CXX)
    if(NOT DEFINED CMAKE_${language}_COMPILER_LAUNCHER)
      set(CMAKE_${language}_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
                                              CCACHE_NOHASHDIR=1 ${DERMIS_CCACHE})
    endif()
  endforeach()
endif()
