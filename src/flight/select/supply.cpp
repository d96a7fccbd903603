#include "flight/select/supply.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace flightwatt::flight {
namespace {

constexpr double block_s = 2.0;
constexpr std::size_t enough_blocks = 10;
constexpr double max_ratio = 1.15;
// Of the largest power of the ESCs.
constexpr double loaded_part = 0.5;
constexpr double idle_part = 0.2;
constexpr double min_rise = 0.2;  // of that of the ESCs; a wrong scale is nearer to 1

/// Means over some seconds, or over blocks of them.
struct PowerMeans {
    double supply_w = 0.0;
    double escs_w = 0.0;
    std::size_t count = 0;

    void add(double more_supply_w, double more_escs_w) {
        ++count;
        supply_w += (more_supply_w - supply_w) / static_cast<double>(count);
        escs_w += (more_escs_w - escs_w) / static_cast<double>(count);
    }
};

/// The means over blocks of the time in which both report.
std::vector<PowerMeans> block_means(const Track& supply_w, const Track& escs_w) {
    std::vector<PowerMeans> blocks;
    const auto supplied_w = resample(supply_w, escs_w.time_s);
    double block = 0.0;
    for (std::size_t i = 0; i < escs_w.time_s.size(); ++i) {
        const double time_s = escs_w.time_s[i];
        if (time_s < supply_w.time_s.front() || time_s > supply_w.time_s.back()) continue;
        if (blocks.empty() || std::floor(time_s / block_s) != block) blocks.emplace_back();
        block = std::floor(time_s / block_s);
        blocks.back().add(supplied_w[i], escs_w.value[i]);
    }
    return blocks;
}

template <typename Counts>
PowerMeans means_where(const std::vector<PowerMeans>& blocks, const Counts& counts) {
    PowerMeans means;
    for (const auto& block : blocks)
        if (counts(block.escs_w)) means.add(block.supply_w, block.escs_w);
    return means;
}

/// The means at rest and under load, by the power of the ESCs.
std::pair<PowerMeans, PowerMeans> idle_and_loaded(const std::vector<PowerMeans>& blocks) {
    const double largest_w = std::ranges::max(blocks, {}, &PowerMeans::escs_w).escs_w;
    return {means_where(blocks, [&](double watts) { return watts <= idle_part * largest_w; }),
            means_where(blocks, [&](double watts) { return watts >= loaded_part * largest_w; })};
}

}  // namespace

std::optional<SupplyShortfall> compare_with_escs(const Track& supply_w, const Track& escs_w) {
    if (supply_w.empty() || escs_w.empty()) return std::nullopt;
    const auto blocks = block_means(supply_w, escs_w);
    if (blocks.size() < enough_blocks) return std::nullopt;
    const auto all = means_where(blocks, [](double) { return true; });
    if (all.escs_w <= max_ratio * all.supply_w || all.escs_w <= 0.0) return std::nullopt;
    const auto [idle, loaded] = idle_and_loaded(blocks);
    const bool is_other = idle.count > 0 && loaded.supply_w - idle.supply_w < min_rise * (loaded.escs_w - idle.escs_w);
    return SupplyShortfall{all.supply_w, all.escs_w, is_other};
}

std::optional<double> rise_beyond_escs(const Track& supply_w, const Track& escs_w) {
    if (supply_w.empty() || escs_w.empty()) return std::nullopt;
    const auto blocks = block_means(supply_w, escs_w);
    if (blocks.size() < enough_blocks) return std::nullopt;
    const auto [idle, loaded] = idle_and_loaded(blocks);
    const double escs_rise_w = loaded.escs_w - idle.escs_w;
    if (idle.count == 0 || !(escs_rise_w > 0.0)) return std::nullopt;
    const double ratio = (loaded.supply_w - idle.supply_w) / escs_rise_w;
    return ratio > max_ratio && ratio * min_rise < 1.0 ? std::optional(ratio) : std::nullopt;
}

}  // namespace flightwatt::flight
