#include "libvdbsynth/geometry/sliver_removal.h"

#include <catch2/catch.hpp>
