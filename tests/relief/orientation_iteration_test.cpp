#include "libvdbsynth/relief/orientation_iteration.h"
