# What `cmake --install` and `cpack -G DEB` deliver; plugins install themselves in submap_slam_plugin().
include(CMakePackageConfigHelpers)

set(submap_slam_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/submap-slam)

install(TARGETS submap-slam submap-viewer RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

# libsubmap-types.so is both what plugins link against and itself an MRPT plugin: RawLogViewer, SceneViewer3D (-l) and
# rawlog-edit (-p) load it by its path to understand files of submaps. So its unversioned name is always installed.
set_target_properties(submap_core PROPERTIES EXPORT_NAME core)
install(TARGETS submap_core EXPORT submap-slamTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY libs/core/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT submap-slamTargets NAMESPACE submap-slam:: DESTINATION ${submap_slam_cmake_dir})

# The dependencies that find_package(submap-slam) must look up are those that submap_core links publicly.
get_target_property(core_interface submap_core INTERFACE_LINK_LIBRARIES)
set(SUBMAP_SLAM_MRPT_DEPENDENCIES "")
foreach(lib ${core_interface})
  if(lib MATCHES "^mrpt::(.+)$")
    list(APPEND SUBMAP_SLAM_MRPT_DEPENDENCIES mrpt-${CMAKE_MATCH_1})
  endif()
endforeach()
configure_package_config_file(cmake/submap-slam-config.cmake.in ${PROJECT_BINARY_DIR}/submap-slam-config.cmake
  INSTALL_DESTINATION ${submap_slam_cmake_dir} PATH_VARS SUBMAP_SLAM_PLUGIN_INSTALL_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/submap-slam-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/submap-slam-config.cmake ${PROJECT_BINARY_DIR}/submap-slam-config-version.cmake
  DESTINATION ${submap_slam_cmake_dir})

install(DIRECTORY ini DESTINATION ${SUBMAP_SLAM_DATA_INSTALL_DIR} FILES_MATCHING PATTERN "*.ini")

# Laid out as in the source tree, so that the links between the pages work.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.png")
install(DIRECTORY plugins rawlogs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "README.md")
install(DIRECTORY libs/report/third_party DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "README.md" PATTERN "LICENSE")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_PACKAGE_NAME submap-slam)
set(CPACK_PACKAGE_VENDOR "The submap-slam authors")
set(CPACK_PACKAGE_CONTACT "submap-slam developers <maintainers@submap-slam.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "mrpt-apps, mrpt-common")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, g++, libmrpt-maps-dev")
include(CPack)
