#include "io/atomic_file.h"
