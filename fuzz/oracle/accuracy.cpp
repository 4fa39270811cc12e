#include "fuzz/oracle/accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "fuzz/oracle/closest_approach.h"

namespace selvage::fuzz {
namespace {

/// For each of five distances: bisecting down to a gap of 2^-50 of the size takes some 50 levels, most of them with two
/// intervals of two tests each.
constexpr int kTestsOfDistance = 256;

/// The largest value that the bin holds.
double most_of(std::size_t bin) { return bin == 0 ? 0 : std::ldexp(1, 1 - static_cast<int>(bin)); }

double quantile(const Accuracy::Histogram& histogram, double count, double share) {
  std::int64_t below = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    // From 0 on, then from the smallest values up.
    const std::size_t from_below = bin == 0 ? 0 : histogram.size() - bin;
    below += histogram[from_below];
    if (below > 0 && static_cast<double>(below) >= share * count) return most_of(from_below);
  }
  return 0;
}

template <std::size_t N>
void add(std::array<std::int64_t, N>& to, const std::array<std::int64_t, N>& from) {
  for (std::size_t i = 0; i < N; ++i) to[i] += from[i];
}

int gap_class(const MotionQuery& query) {
  const std::array<double, 2> hints{1, 0};
  const double size = extent(query);
  for (std::size_t i = 0; i < Accuracy::kGaps.size(); ++i) {
    const double d = std::ldexp(size, Accuracy::kGaps[i]);
    if (closest_approach(query, d, hints, kTestsOfDistance) == Approach::kBeyond) return static_cast<int>(i);
  }
  return static_cast<int>(Accuracy::kGaps.size());
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

std::string line(const char* name, const Spread& time, const Spread& distance, double Spread::*value) {
  return formatted("    %-24s %12.3g %12.3g\n", name, time.*value, distance.*value);
}

}  // namespace

int bin_of(double x) {
  if (!(x > 0)) return 0;
  int exponent = 0;
  if (std::frexp(x, &exponent) == 0.5) --exponent;  // then x <= 2^exponent
  return std::clamp(1 - exponent, 1, static_cast<int>(Accuracy::kBins) - 1);
}

void Accuracy::add(const AccuracySample& sample) {
  if (sample.early_time >= 0) {
    ++early_time.at(static_cast<std::size_t>(sample.early_time));
    ++early_distance.at(static_cast<std::size_t>(sample.early_distance));
  }
  if (sample.gap >= 0) {
    ++apart.at(static_cast<std::size_t>(sample.gap));
    alarms.at(static_cast<std::size_t>(sample.gap)) += sample.alarm ? 1 : 0;
  }
}

Accuracy& Accuracy::operator+=(const Accuracy& other) {
  fuzz::add(early_time, other.early_time);
  fuzz::add(early_distance, other.early_distance);
  fuzz::add(apart, other.apart);
  fuzz::add(alarms, other.alarms);
  return *this;
}

AccuracySample measure_accuracy(const MotionQuery& query, bool touches, bool alarm, std::optional<double> toi) {
  AccuracySample sample;
  sample.alarm = alarm;
  if (!touches) {
    sample.gap = gap_class(query);
  } else if (alarm && toi) {
    sample.early_time = bin_of(exact_motion(query, verify::Detail::kFirstTime).first.upper_approx - *toi);
    const double size = extent(query);
    sample.early_distance = size > 0 ? bin_of(rounded_distance(query, *toi) / size) : 0;
  }
  return sample;
}

Spread spread_of(const Accuracy::Histogram& histogram) {
  Spread spread;
  spread.count = std::accumulate(histogram.begin(), histogram.end(), std::int64_t{0});
  if (spread.count == 0) return spread;
  const auto count = static_cast<double>(spread.count);
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    spread.mean += static_cast<double>(histogram[bin]) * most_of(bin) / count;
  }
  spread.half = quantile(histogram, count, 0.5);
  spread.nine_tenths = quantile(histogram, count, 0.9);
  spread.all_but_a_hundredth = quantile(histogram, count, 0.99);
  spread.worst = quantile(histogram, count, 1);
  return spread;
}

std::string accuracy_text(const Accuracy& accuracy) {
  std::string text;
  const Spread time = spread_of(accuracy.early_time), distance = spread_of(accuracy.early_distance);
  if (time.count > 0) {
    text += formatted("  how early times of impact are at most, of %lld touches measured\n    %-24s %12s %12s\n",
                      static_cast<long long>(time.count), "", "of the step", "of the size");
    text += line("mean", time, distance, &Spread::mean) + line("half of them", time, distance, &Spread::half) +
            line("90 %", time, distance, &Spread::nine_tenths) +
            line("99 %", time, distance, &Spread::all_but_a_hundredth) + line("all", time, distance, &Spread::worst);
  }
  const auto apart = std::accumulate(accuracy.apart.begin(), accuracy.apart.end(), std::int64_t{0});
  if (apart == 0) return text;
  text += formatted("  called a collision, of %lld cases measured that stay apart\n    %-24s %12s %12s %8s\n",
                    static_cast<long long>(apart), "by more than, of the size", "apart", "called so", "share");
  for (std::size_t i = 0; i < accuracy.apart.size(); ++i) {
    const std::string bound =
        i < Accuracy::kGaps.size() ? formatted("2^%d", Accuracy::kGaps.at(i)) : std::string("0, or not known");
    const double share = accuracy.apart[i] > 0
                             ? 100 * static_cast<double>(accuracy.alarms[i]) / static_cast<double>(accuracy.apart[i])
                             : 0;
    text += formatted("    %-24s %12lld %12lld %6.3g %%\n", bound.c_str(), static_cast<long long>(accuracy.apart[i]),
                      static_cast<long long>(accuracy.alarms[i]), share);
  }
  return text;
}

}  // namespace selvage::fuzz
