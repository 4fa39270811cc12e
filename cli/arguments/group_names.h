// Groups as the command line names them.
#pragma once

#include <string>
#include <vector>

#include "io/mesh_data.h"

namespace selvage::cli {

/// Throws UsageError where one of `names`, given by `option`, is the name of none of the groups, and lists these.
void require_known(const std::string& option, const std::vector<std::string>& names,
                   const std::vector<io::Group>& groups);

}  // namespace selvage::cli
