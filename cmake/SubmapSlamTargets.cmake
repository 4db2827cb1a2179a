# Functions that declare our libraries, plugins and tests the same way everywhere.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(SUBMAP_SLAM_PLUGIN_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/submap-slam/plugins)
set(SUBMAP_SLAM_PLUGIN_INSTALL_DIR ${CMAKE_INSTALL_LIBDIR}/submap-slam/plugins)
set(SUBMAP_SLAM_DATA_INSTALL_DIR ${CMAKE_INSTALL_DATADIR}/submap-slam)
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}:$ORIGIN:$ORIGIN/../..")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(submap_slam_options INTERFACE)
# No contraction to fused multiply-add and no reassociation: the compiler does not change results.
target_compile_options(submap_slam_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off $<$<BOOL:${SUBMAP_SLAM_WERROR}>:-Werror>)
if(SUBMAP_SLAM_SANITIZE)
  target_compile_options(submap_slam_options INTERFACE
    -fsanitize=${SUBMAP_SLAM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    -fno-sanitize=alignment  # of MRPT's virtual bases gcc asks the alignment of whole objects
    -Wno-subobject-linkage     # several sources are read as one, whose namespaces without a name gcc takes for headers'
    -Wno-maybe-uninitialized)  # sanitized code confuses that warning, as gcc's manual says
  target_link_options(submap_slam_options INTERFACE -fsanitize=${SUBMAP_SLAM_SANITIZE})
  # Under a sanitizer Eigen would align by itself, and free what MRPT's libraries, built without one, allocate.
  target_compile_definitions(submap_slam_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

# submap_slam_library(NAME [SHARED] SOURCES … DEPENDS …): a library of libs/<dir> with its include folder.
function(submap_slam_library name)
  cmake_parse_arguments(ARG "SHARED" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  if(ARG_SHARED)
    add_library(${name} SHARED ${ARG_SOURCES})
  else()
    add_library(${name} STATIC ${ARG_SOURCES})
  endif()
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${name} PUBLIC ${ARG_DEPENDS}
    PRIVATE ${ARG_PRIVATE_DEPENDS} $<BUILD_INTERFACE:submap_slam_options>)
  target_compile_features(${name} PUBLIC cxx_std_17)
endfunction()

# submap_slam_plugin(NAME SOURCES … DEPENDS …): a joiner plugin, found by the app in the plugin folder.
function(submap_slam_plugin name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(${name} MODULE ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE submap_core ${ARG_DEPENDS} submap_slam_options)
  # MRPT's class registry points into a plugin to the end; unloading one before would leave it dangling.
  target_link_options(${name} PRIVATE LINKER:-z,nodelete)
  set_target_properties(${name} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${SUBMAP_SLAM_PLUGIN_OUTPUT_DIRECTORY} PREFIX "" INSTALL_RPATH "$ORIGIN/../..")
  install(TARGETS ${name} LIBRARY DESTINATION ${SUBMAP_SLAM_PLUGIN_INSTALL_DIR})
endfunction()

# submap_slam_test(NAME SOURCES … DEPENDS … LABELS …): a GoogleTest program whose cases ctest lists one by one.
function(submap_slam_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} GTest::gmock_main submap_slam_options)
  target_compile_definitions(${name} PRIVATE
    SUBMAP_SLAM_SOURCE_DIR="${PROJECT_SOURCE_DIR}" SUBMAP_SLAM_BINARY_DIR="${PROJECT_BINARY_DIR}")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300 LABELS "${ARG_LABELS}")
endfunction()
