// A sequence that contradicts itself.
#pragma once

#include <filesystem>

#include "tests/temporary_folder.h"

namespace selvage::testing {

/// Has the sequence of two faces or more in `folder` say that face 1 is of a cloth and of a body, which no writer of
/// ours does.
inline void give_two_roles(const std::filesystem::path& folder) {
  spit(folder / "sequence.json",
       R"({"schema": "selvage.sequence/1", "producer": "test", "kind": "frames", "precision": "float64",
           "faces": {"file": "faces.npy"}, "frames": "frames.jsonl",
           "groups": [{"name": "coat", "role": "cloth", "faces": [0, 2]},
                      {"name": "arm", "role": "body", "faces": [1, 2]}]})");
}

}  // namespace selvage::testing
