# SPDX-License-Identifier: Apache-2.0
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY DERMIS_MODULES)
install(TARGETS dermis ${modules} EXPORT dermis-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET dermis_c)
  install(TARGETS dermis_c EXPORT dermis-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(FILES bindings/c/dermis.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endif()
foreach(plugin dermis_fast_dds dermis_cairo dermis_libhdf5 dermis_libmodbus dermis_open_mpi dermis_cnats)
  if(TARGET ${plugin})
    install(TARGETS ${plugin} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
endforeach()
if(TARGET dermis_cli)
  install(TARGETS dermis_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${PROJECT_BINARY_DIR}/share/ DESTINATION ${CMAKE_INSTALL_DATADIR} PATTERN doc EXCLUDE)  # docs/ has them
endif()
install(DIRECTORY include/dermis ${PROJECT_BINARY_DIR}/include/dermis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT dermis-targets NAMESPACE dermis:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/dermis)

list(TRANSFORM modules REPLACE "^dermis_" "" OUTPUT_VARIABLE DERMIS_COMPONENTS)
list(JOIN DERMIS_COMPONENTS " " DERMIS_COMPONENTS)
configure_package_config_file(cmake/dermis-config.cmake.in ${PROJECT_BINARY_DIR}/dermis-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/dermis)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/dermis-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/dermis-config.cmake ${PROJECT_BINARY_DIR}/dermis-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/dermis)

# The messages as a package of ROS 2, in sources: each workspace builds it for its own ROS.
set(package ${CMAKE_INSTALL_DATADIR}/dermis/ros/dermis_msgs)
install(FILES bindings/ros/dermis_msgs/CMakeLists.txt bindings/ros/dermis_msgs/package.xml DESTINATION ${package} COMPONENT ros EXCLUDE_FROM_ALL)
install(DIRECTORY src/bytes/ros_messages/msg/dermis_msgs/ DESTINATION ${package}/msg COMPONENT ros EXCLUDE_FROM_ALL)
