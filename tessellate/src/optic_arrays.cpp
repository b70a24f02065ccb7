#include "tessellate/optic_arrays.h"
