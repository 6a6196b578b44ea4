/// The program `noether`.

#include "cli/program.hpp"

int main(int argc, char** argv) { return noether::program(argc, argv); }
