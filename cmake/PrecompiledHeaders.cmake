# Headers of other projects that most sources read, compiled once: halves the time of a build that no compiler cache
# helps with. For the sanitizer builds; other builds see that every source names what it needs.
function(submap_slam_precompile_headers)
  set(headers
    <mrpt/math/TPose2D.h> <mrpt/math/wrap2pi.h> <mrpt/obs/CObservation2DRangeScan.h> <mrpt/opengl/Visualizable.h>
    <mrpt/poses/CPosePDFGaussian.h> <mrpt/serialization/CArchive.h>
    <Eigen/Dense>
    <algorithm> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <string> <vector>)
  file(WRITE ${PROJECT_BINARY_DIR}/precompiled/empty.cpp "")
  # Programs are compiled with -fPIE, libraries with -fPIC, so there is one set for each.
  add_library(precompiled_for_libraries OBJECT ${PROJECT_BINARY_DIR}/precompiled/empty.cpp)
  add_executable(precompiled_for_programs ${PROJECT_BINARY_DIR}/precompiled/main.cpp)
  file(WRITE ${PROJECT_BINARY_DIR}/precompiled/main.cpp "int main() {}\n")
  set(projects mrpt::obs mrpt::opengl mrpt::poses mrpt::serialization Eigen3::Eigen submap_slam_options)
  target_link_libraries(precompiled_for_libraries PRIVATE ${projects})
  target_link_libraries(precompiled_for_programs PRIVATE ${projects})
  target_precompile_headers(precompiled_for_libraries PRIVATE ${headers})
  target_precompile_headers(precompiled_for_programs PRIVATE ${headers})
  submap_slam_reuse_headers(${PROJECT_SOURCE_DIR})
endfunction()

# All targets of a folder and those below it.
function(submap_slam_reuse_headers folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(target MATCHES "^precompiled_for_")
      continue()
    elseif(type STREQUAL EXECUTABLE)
      target_precompile_headers(${target} REUSE_FROM precompiled_for_programs)
    elseif(type MATCHES "LIBRARY" AND NOT type STREQUAL INTERFACE_LIBRARY)
      target_precompile_headers(${target} REUSE_FROM precompiled_for_libraries)
    endif()
  endforeach()
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS below)
    submap_slam_reuse_headers(${subfolder})
  endforeach()
endfunction()
