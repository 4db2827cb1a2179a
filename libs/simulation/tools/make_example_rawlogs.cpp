#include <submap_slam/simulation/simulate.h>

#include <exception>
#include <iostream>

/** Writes the example rawlogs, with their ground truth, into a folder. */
int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_example_rawlogs FOLDER\n";
    return 2;
  }
  try {
    submap_slam::writeExampleLogs(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << "make_example_rawlogs: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
