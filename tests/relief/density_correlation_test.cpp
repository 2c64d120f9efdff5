#include "libvdbsynth/relief/density_correlation.h"
