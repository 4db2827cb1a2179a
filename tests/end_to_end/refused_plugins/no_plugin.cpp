// A shared library that forgot SUBMAP_SLAM_PLUGIN().
extern "C" int answer();
extern "C" int answer() { return 42; }
