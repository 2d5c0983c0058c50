#include "host/app/program.h"

int main(int argc, char** argv) { return emax::run_program(argc, argv); }
