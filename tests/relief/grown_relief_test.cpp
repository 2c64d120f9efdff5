#include "libvdbsynth/relief/grown_relief.h"
