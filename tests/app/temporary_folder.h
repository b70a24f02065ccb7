// The folder of a test's own, under the name that tests of this folder know.
#pragma once

#include "tests/support/temporary_folder.h"
