#include "libvdbsynth/relief/relief_distance.h"
