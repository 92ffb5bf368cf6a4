#include "sim/fakes.hpp"
