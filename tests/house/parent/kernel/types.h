#pragma once

// Called as one of Selvage's headers is.
inline constexpr bool parents_own = true;
