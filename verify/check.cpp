#include "verify/check.h"
