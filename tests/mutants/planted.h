// Which defect is switched on. Only planted copies of sources (planting.h) and the program that runs them know it.
#pragma once

namespace selvage::mutants {

/// 0: none, all code is as it was written; k: the k-th mutant of the lists. Set while nothing else runs.
extern int planted;

}  // namespace selvage::mutants
