#include "libvdbsynth/relief/relief_match.h"
