// What a ledger's file may say: it comes from other machines.
#include <filesystem>

#include <gtest/gtest.h>

#include "fuzz/ledger/ledger.h"
#include "io/file/text.h"

namespace selvage::fuzz {
namespace {

/// Of one failure, kept in a file of that name.
Ledger with_finding(const std::string& file) {
  PropertyLedger property;
  property.name = "ccd";
  property.streams = {"touch vf"};
  property.rows = {Counts{1000, 1}};
  property.findings[{"touch vf", "missed"}] = {1, 17, file};
  Ledger ledger;
  ledger.version = "1";
  ledger.target = "selvage";
  ledger.properties = {property};
  return ledger;
}

}  // namespace

TEST(LedgerJson, ComesBack) {
  for (const char* file : {"", "ccd-touch-vf-missed.case", "..case"}) {
    Ledger ledger = with_finding(file);
    ledger.properties[0].accuracy.resize(1);
    EXPECT_EQ(parse_ledger(to_json(ledger), "campaign.json"), ledger) << file;
  }
}

TEST(LedgerJson, AFindingNamesNoFileInAnotherFolder) {
  for (const char* file : {"../escaped.case", "/etc/passwd", "cases/a.case", ".", "..", "a/", "a\nb"}) {
    try {
      (void)parse_ledger(to_json(with_finding(file)), "campaign.json");
      FAIL() << file;
    } catch (const io::Error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("campaign.json"), std::string::npos) << message;
      EXPECT_NE(message.find(io::printable(file)), std::string::npos) << message;
    }
  }
}

}  // namespace selvage::fuzz
