#include "flight/series_file/series_table.h"

#include "base/number.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

namespace flightwatt::flight {
namespace {

/// The times that tracks of one message share, and those tracks, in their order.
struct Clock {
    const std::vector<double>* time_s;
    std::vector<std::size_t> tracks;
};

/// Whether two tracks seem to have one clock.
bool are_alike(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && (a.empty() || (a.front() == b.front() && a.back() == b.back()));
}

/// Comparing times takes as long as reading them: each track's are compared beside the others', with those of the first
/// track that seems to have the same. Nearly always they are.
std::vector<Clock> clocks_of(const std::vector<Track>& tracks, std::size_t max_threads) {
    std::vector<std::size_t> alike(tracks.size());
    std::vector<std::uint8_t> is_same(tracks.size());
    for_each_in_parallel(
        tracks.size(),
        [&](std::size_t t) {
            while (!are_alike(tracks[alike[t]].time_s, tracks[t].time_s)) ++alike[t];
            is_same[t] = alike[t] == t || tracks[alike[t]].time_s == tracks[t].time_s ? 1 : 0;
        },
        max_threads);
    std::vector<Clock> clocks;
    for (std::size_t t = 0; t < tracks.size(); ++t) {
        const auto* const first_s = &tracks[alike[t]].time_s;
        const auto is_its = [&](const Clock& clock) {
            return is_same[t] != 0 ? clock.time_s == first_s : *clock.time_s == tracks[t].time_s;
        };
        auto found = std::ranges::find_if(clocks, is_its);
        if (found == clocks.end()) found = clocks.insert(found, {&tracks[t].time_s, {}});
        found->tracks.push_back(t);
    }
    return clocks;
}

/// The samples [first, last) of a clock.
struct Samples {
    std::size_t first;
    std::size_t last;

    std::size_t size() const { return last - first; }
};

/// Rows that follow each other: the samples of each clock in one stretch of time.
using Rows = std::vector<Samples>;

std::size_t samples_in(const Rows& rows) {
    std::size_t count = 0;
    for (const auto& samples : rows) count += samples.size();
    return count;
}

/// Cuts rows in two, again and again, until none of the pieces, which follow each other, has too many samples.
void cut_rows(const std::vector<Clock>& clocks, Rows rows, std::vector<Rows>& pieces) {
    constexpr std::size_t max_samples = 4096;
    const auto densest = std::ranges::max_element(rows, {}, &Samples::size) - rows.begin();
    const auto& samples = rows[static_cast<std::size_t>(densest)];
    if (samples_in(rows) <= max_samples || samples.size() < 2) return pieces.push_back(std::move(rows));
    const double from_s = (*clocks[static_cast<std::size_t>(densest)].time_s)[samples.first + samples.size() / 2];
    auto later = rows;
    for (std::size_t c = 0; c < clocks.size(); ++c) {
        const auto begin = clocks[c].time_s->begin();
        const auto cut = std::lower_bound(begin + static_cast<std::ptrdiff_t>(rows[c].first),
                                          begin + static_cast<std::ptrdiff_t>(rows[c].last), from_s);
        rows[c].last = later[c].first = static_cast<std::size_t>(cut - begin);
    }
    cut_rows(clocks, std::move(rows), pieces);
    cut_rows(clocks, std::move(later), pieces);
}

constexpr std::size_t commas_at_once = 32;

/// May write `commas_at_once` characters, of which those behind the commas do not count.
char* write_commas(char* to, std::size_t count) {
    if (count > commas_at_once) {
        std::memset(to, ',', count);
    } else {
        static constexpr auto commas = [] {
            std::array<char, commas_at_once> filled{};
            filled.fill(',');
            return filled;
        }();
        std::memcpy(to, commas.data(), commas_at_once);
    }
    return to + count;
}

/// Writes rows into room for the longest numbers, which is touched only as far as it is written.
class RowsText {
  public:
    RowsText(const std::vector<Track>& tracks, const std::vector<Clock>& clocks)
        : tracks_(tracks), clocks_(clocks), clock_of_(tracks.size()) {
        for (std::size_t c = 0; c < clocks.size(); ++c) {
            times_s_.push_back(clocks[c].time_s->data());
            for (const auto track : clocks[c].tracks) clock_of_[track] = c;
        }
        for (const auto& track : tracks) values_.push_back(track.value.data());
    }

    void write(const Rows& rows) {
        make_room(rows);
        next_ = rows;
        next_s_.resize(rows.size());
        for (std::size_t c = 0; c < rows.size(); ++c) next_s_[c] = time_of_next(c);
        last_.assign(tracks_.size(), {});
        end_ = text_.get();
        for (auto left = samples_in(rows); left > 0;) left -= write_row();
    }

    std::string_view text() const { return {text_.get(), end_}; }

  private:
    /// What was written of a track last: many values come again and again.
    struct Written {
        std::uint64_t bits = 0;
        const char* text = nullptr;
        std::size_t size = 0;
    };

    void make_room(const Rows& rows) {
        std::size_t numbers = 0;
        for (std::size_t c = 0; c < rows.size(); ++c) numbers += rows[c].size() * (clocks_[c].tracks.size() + 1);
        const auto room = numbers * number_buffer_size + samples_in(rows) * (tracks_.size() + 1) + commas_at_once +
                          number_buffer_size;
        if (room <= room_) return;
        text_.reset(new char[room]);
        room_ = room;
    }

    double time_of_next(std::size_t clock) const {
        const auto& [next, last] = next_[clock];
        return next < last ? times_s_[clock][next] : std::numeric_limits<double>::infinity();
    }

    /// Of the earliest time. Returns how many samples it holds.
    std::size_t write_row() {
        // Which clock comes next can hardly be guessed: three passes without a branch are quicker than one with it.
        double time_s = std::numeric_limits<double>::infinity();
        for (const double next_s : next_s_) time_s = next_s < time_s ? next_s : time_s;
        std::size_t together = 0;
        for (const double next_s : next_s_) together += next_s == time_s ? 1 : 0;
        std::size_t earliest = 0;
        while (next_s_[earliest] != time_s) ++earliest;
        char* to = write_number(end_, time_s);
        std::size_t column = 0;
        const auto write_cell = [&](std::size_t track, std::size_t clock) {
            to = write_value(write_commas(to, track + 1 - column), track, next_[clock].first);
            column = track + 1;
        };
        if (together == 1) {
            for (const auto track : clocks_[earliest].tracks) write_cell(track, earliest);
        } else {
            for (std::size_t t = 0; t < tracks_.size(); ++t)
                if (next_s_[clock_of_[t]] == time_s) write_cell(t, clock_of_[t]);
        }
        to = write_commas(to, tracks_.size() - column);
        *to++ = '\n';
        end_ = to;
        pass(earliest);
        for (auto c = earliest + 1; together > 1 && c < next_s_.size(); ++c)
            if (next_s_[c] == time_s) pass(c);
        return together;
    }

    void pass(std::size_t clock) {
        ++next_[clock].first;
        next_s_[clock] = time_of_next(clock);
    }

    char* write_value(char* to, std::size_t track, std::size_t sample) {
        const double value = values_[track][sample];
        auto& last = last_[track];
        const auto bits = std::bit_cast<std::uint64_t>(value);
        if (last.text != nullptr && last.bits == bits) {
            std::memmove(to, last.text, max_number_chars);
        } else {
            last = {bits, to, static_cast<std::size_t>(write_number(to, value) - to)};
        }
        return to + last.size;
    }

    const std::vector<Track>& tracks_;
    const std::vector<Clock>& clocks_;
    std::vector<std::size_t> clock_of_;   ///< of each track
    std::vector<const double*> times_s_;  ///< of each clock
    std::vector<const double*> values_;   ///< of each track
    std::unique_ptr<char[]> text_;        // NOLINT(modernize-avoid-c-arrays): a string would be filled with zeros first
    std::size_t room_ = 0;
    char* end_ = nullptr;
    Rows next_;                   ///< what is left of each clock
    std::vector<double> next_s_;  ///< the time of its next sample, infinite where none is left
    std::vector<Written> last_;   ///< of each track
};

}  // namespace

void write_series_rows(const std::vector<Track>& tracks, const TextSink& sink, std::size_t max_threads) {
    const auto clocks = clocks_of(tracks, max_threads);
    Rows all;
    for (const auto& clock : clocks) all.push_back({0, clock.time_s->size()});
    std::vector<Rows> pieces;
    if (samples_in(all) > 0) cut_rows(clocks, std::move(all), pieces);
    std::vector<RowsText> texts;
    for (std::size_t k = 0; k < threads_for(pieces.size(), max_threads); ++k) texts.emplace_back(tracks, clocks);
    for_each_in_order(
        pieces.size(), [&](std::size_t i, std::size_t place) { texts[place].write(pieces[i]); },
        [&](std::size_t, std::size_t place) { sink(texts[place].text()); }, max_threads);
}

}  // namespace flightwatt::flight
