#include "flight/series_file/series_table.h"

#include "base/number.h"
#include "base/parallel.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

namespace flightwatt::flight {
namespace {

/// Tracks of one message share their times: each is looked at once a row.
struct Clocks {
    std::vector<const std::vector<double>*> time_s;  ///< that differ
    std::vector<std::size_t> of_track;
};

Clocks clocks_of(const std::vector<Track>& tracks) {
    Clocks clocks;
    for (const auto& track : tracks) {
        const auto is_same = [&](const auto* time_s) { return *time_s == track.time_s; };
        const auto found = std::ranges::find_if(clocks.time_s, is_same);
        clocks.of_track.push_back(static_cast<std::size_t>(found - clocks.time_s.begin()));
        if (found == clocks.time_s.end()) clocks.time_s.push_back(&track.time_s);
    }
    return clocks;
}

std::vector<double> united(const std::vector<double>& one, const std::vector<double>& other) {
    std::vector<double> both;
    both.reserve(one.size() + other.size());
    std::ranges::set_union(one, other, std::back_inserter(both));
    return both;
}

/// Every time once, by merging two and two.
std::vector<double> all_times(const Clocks& clocks) {
    std::vector<std::vector<double>> merged;
    for (const auto* time_s : clocks.time_s) merged.push_back(*time_s);
    while (merged.size() > 1) {
        std::vector<std::vector<double>> fewer;
        for (std::size_t i = 0; i < merged.size(); i += 2)
            fewer.push_back(i + 1 < merged.size() ? united(merged[i], merged[i + 1]) : std::move(merged[i]));
        merged = std::move(fewer);
    }
    return merged.empty() ? std::vector<double>() : std::move(merged.front());
}

/// A run of rows, in room for the longest numbers, which is touched only as far as it is written.
class Block {
  public:
    static constexpr std::size_t most_rows = 4096;

    explicit Block(std::size_t tracks) : text_(new char[most_rows * (tracks + 1) * (longest_number + 1)]) {}

    void fill(const std::vector<Track>& tracks, const Clocks& clocks, std::span<const double> row_times_s) {
        next_.clear();
        for (const auto* time_s : clocks.time_s) {
            const auto first = std::ranges::lower_bound(*time_s, row_times_s.front());
            next_.push_back(static_cast<std::size_t>(first - time_s->begin()));
        }
        has_value_.resize(next_.size());
        end_ = text_.get();
        for (const double time_s : row_times_s) write_row(tracks, clocks, time_s);
    }

    std::string_view text() const { return {text_.get(), end_}; }

  private:
    void write_row(const std::vector<Track>& tracks, const Clocks& clocks, double time_s) {
        for (std::size_t c = 0; c < next_.size(); ++c) {
            const auto& times_s = *clocks.time_s[c];
            has_value_[c] = next_[c] < times_s.size() && times_s[next_[c]] == time_s;
        }
        char* to = write_number(end_, time_s);
        for (std::size_t t = 0; t < tracks.size(); ++t) {
            *to++ = ',';
            const auto clock = clocks.of_track[t];
            if (has_value_[clock] != 0) to = write_number(to, tracks[t].value[next_[clock]]);
        }
        *to++ = '\n';
        end_ = to;
        for (std::size_t c = 0; c < next_.size(); ++c) next_[c] += has_value_[c];
    }

    std::unique_ptr<char[]> text_;  // NOLINT(modernize-avoid-c-arrays): a string would be filled with zeros first
    char* end_ = nullptr;
    std::vector<std::size_t> next_;        ///< of each clock
    std::vector<std::uint8_t> has_value_;  ///< at the row's time
};

}  // namespace

void write_series_rows(const std::vector<Track>& tracks, const TextSink& sink, std::size_t most_threads) {
    const auto clocks = clocks_of(tracks);
    const auto time_s = all_times(clocks);
    const auto blocks = (time_s.size() + Block::most_rows - 1) / Block::most_rows;
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    const auto at_once = std::min(blocks, most_threads > 0 ? most_threads : cores);
    std::vector<Block> made;
    for (std::size_t k = 0; k < at_once; ++k) made.emplace_back(tracks.size());
    for (std::size_t first = 0; first < blocks; first += at_once) {
        const auto count = std::min(at_once, blocks - first);
        for_each_in_parallel(
            count,
            [&](std::size_t k) {
                const auto begin = (first + k) * Block::most_rows;
                const auto rows = std::min(Block::most_rows, time_s.size() - begin);
                made[k].fill(tracks, clocks, std::span(time_s).subspan(begin, rows));
            },
            at_once);
        for (std::size_t k = 0; k < count; ++k) sink(made[k].text());
    }
}

}  // namespace flightwatt::flight
