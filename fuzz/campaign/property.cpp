#include "fuzz/campaign/property.h"

#include "fuzz/campaign/broad_campaign.h"
#include "fuzz/campaign/collisions_campaign.h"
#include "fuzz/campaign/file_campaign.h"
#include "fuzz/campaign/query_campaign.h"
#include "fuzz/campaign/simulation_campaign.h"
#include "fuzz/campaign/step_campaign.h"
#include "fuzz/campaign/subdivision_campaign.h"

namespace selvage::fuzz {

std::uint64_t case_seed(std::uint64_t seed, const Stream& stream, std::int64_t number) {
  // The stream enters by name, so that adding one leaves the cases of the others alone.
  std::uint64_t key = seed;
  for (const char letter : stream.name) key = mix(key, static_cast<std::uint64_t>(letter));
  return mix(key, static_cast<std::uint64_t>(number));
}

Properties all_properties() {
  Properties properties;
  for (const QueryProperty& property : query_properties()) properties.push_back(make_query_campaign(property));
  properties.push_back(make_broad_campaign());
  properties.push_back(make_collisions_campaign());
  properties.push_back(make_step_campaign());
  properties.push_back(make_simulation_campaign());
  properties.push_back(make_subdivision_campaign());
  properties.push_back(make_file_campaign());
  return properties;
}

}  // namespace selvage::fuzz
