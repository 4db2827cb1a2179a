# Everything comes from Debian 12 packages; scripts/install-dependencies names them.
find_package(mrpt-core REQUIRED)
foreach(lib rtti serialization io system containers poses math random obs maps opengl img bayes graphs gui)
  find_package(mrpt-${lib} REQUIRED)
endforeach()
find_package(Eigen3 REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Ceres REQUIRED)  # finds SuiteSparse too: SuiteSparse::CHOLMOD
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_library(SUBMAP_SLAM_DEFLATE deflate REQUIRED)  # compresses three times as fast as zlib
