#include "cli/program.h"

int main(int argc, char** argv) { return wavelobe::run_program(argc, argv); }
