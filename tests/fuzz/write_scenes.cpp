// Writes the scenes of tests/scenes/bad/scenes.txt as seeds: write_scenes FOLDER.

#include "tests/support/scene_table.hpp"

#include <iostream>

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "write_scenes takes one folder\n";
    return 2;
  }
  noether::test::write_scene_table(arguments[1]);
  return 0;
}
