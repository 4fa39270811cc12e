#include "verify/report/library_versions.h"

#include <CGAL/version.h>
#include <gmp.h>

namespace selvage::verify {

std::string library_versions() { return std::string("CGAL ") + CGAL_VERSION_STR + ", GMP " + gmp_version; }

}  // namespace selvage::verify
