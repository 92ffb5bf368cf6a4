#include <iostream>

#include <unistd.h>

#include "daemon/ctl/fvdctl.hpp"

int main(int argc, char** argv) {
  const fvd::ctl::Terminal terminal{std::cout, std::cerr, isatty(STDOUT_FILENO) == 1, isatty(STDERR_FILENO) == 1,
                                    STDIN_FILENO};
  return fvd::ctl::run_fvdctl({argv + 1, argv + argc}, terminal);
}
