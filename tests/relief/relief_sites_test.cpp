#include "libvdbsynth/relief/relief_sites.h"
