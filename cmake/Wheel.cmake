# SPDX-License-Identifier: Apache-2.0
# The component "wheel" of an installation is what a wheel holds, at its places there (bindings/python/build_backend.py).
# Libraries and modules find each other in the folder of the package; the command finds it beside its own folder.
get_property(modules GLOBAL PROPERTY DERMIS_PYTHON_MODULES)
set(libraries ${modules} ${DERMIS_PYTHON_LIBRARIES})
if(DERMIS_SHARED)
  set_target_properties(${libraries} PROPERTIES INSTALL_RPATH "$ORIGIN")
  # Of a Python or a virtual environment, of pip --user, of Fedora, of Debian's root, of pip --target.
  set(places)
  foreach(minor RANGE 9 14)
    list(APPEND places "$ORIGIN/../lib/python3.${minor}/site-packages/dermis" "$ORIGIN/../lib64/python3.${minor}/site-packages/dermis"
                       "$ORIGIN/../lib/python3.${minor}/dist-packages/dermis")
  endforeach()
  set_target_properties(dermis_cli PROPERTIES INSTALL_RPATH "${places};$ORIGIN/../dermis")
endif()

set(data dermis-${PROJECT_VERSION}.data)
set(share ${data}/data/share)
set(wheel COMPONENT wheel EXCLUDE_FROM_ALL)
file(GLOB package CONFIGURE_DEPENDS bindings/python/dermis/*)
install(TARGETS ${libraries} LIBRARY DESTINATION dermis ${wheel})
install(FILES ${package} DESTINATION dermis ${wheel})
install(TARGETS dermis_cli RUNTIME DESTINATION ${data}/scripts ${wheel})
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/ DESTINATION ${share} ${wheel} PATTERN doc EXCLUDE)
install(DIRECTORY examples/chest examples/suit examples/small examples/python DESTINATION ${share}/doc/dermis/examples ${wheel}
        PATTERN __pycache__ EXCLUDE)
install(FILES packaging/debian/dermis.udev DESTINATION ${share}/dermis RENAME 60-dermis.rules ${wheel})
install(FILES bindings/ros/dermis_msgs/CMakeLists.txt bindings/ros/dermis_msgs/package.xml
        DESTINATION ${share}/dermis/ros/dermis_msgs ${wheel})
install(DIRECTORY src/bytes/ros_messages/msg/dermis_msgs/ DESTINATION ${share}/dermis/ros/dermis_msgs/msg ${wheel})
