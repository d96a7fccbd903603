#include "batch/log_list.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace flightwatt::batch {
namespace {

constexpr std::size_t fields = 5;
using Lengths = std::array<std::uint32_t, fields>;

constexpr unsigned char of_this_run = 1;
constexpr unsigned char gone = 2;
constexpr unsigned char place_is_path = 4;

std::vector<std::size_t> numbers_below(std::size_t count) {
    std::vector<std::size_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    return numbers;
}

}  // namespace

LogList::LogList(const std::vector<LogFile>& logs) {
    for (const auto& log : logs) push_back(log);
}

void LogList::push_back(const LogFile& log) {
    const bool is_place_path = log.place == log.path;
    const std::array<std::string_view, fields> texts{log.path, log.flight, log.why_not_fitted, log.problem,
                                                     is_place_path ? "" : std::string_view(log.place)};
    Lengths lengths{};
    std::ranges::transform(texts, lengths.begin(), [](auto text) { return static_cast<std::uint32_t>(text.size()); });
    starts_.push_back(bytes_.size());
    bytes_.push_back(static_cast<char>((log.is_of_this_run ? of_this_run : 0) | (log.is_missing ? gone : 0) |
                                       (is_place_path ? place_is_path : 0)));
    const auto append = [this](std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); };
    std::array<char, sizeof(Lengths)> framed{};
    std::memcpy(framed.data(), lengths.data(), framed.size());
    append({framed.data(), framed.size()});
    for (const auto text : texts) append(text);
}

std::string_view LogList::text(std::size_t number, std::size_t field) const {
    const auto start = starts_.at(number) + 1;
    Lengths lengths{};
    std::memcpy(lengths.data(), bytes_.data() + start, sizeof(lengths));
    const auto before =
        std::accumulate(lengths.begin(), lengths.begin() + static_cast<std::ptrdiff_t>(field), std::uint64_t{0});
    return std::string_view(bytes_.data(), bytes_.size()).substr(start + sizeof(lengths) + before, lengths.at(field));
}

std::string_view LogList::place(std::size_t number) const {
    const bool is_path = (static_cast<unsigned char>(bytes_[starts_.at(number)]) & place_is_path) != 0;
    return text(number, is_path ? 0 : 4);
}

LogFile LogList::operator[](std::size_t number) const {
    const auto flags = static_cast<unsigned char>(bytes_[starts_.at(number)]);
    const auto field = [&](std::size_t which) { return std::string(text(number, which)); };
    return {field(0),
            field(1),
            field(2),
            field(3),
            (flags & of_this_run) != 0,
            (flags & gone) != 0,
            std::string(place(number))};
}

std::vector<std::size_t> LogList::by_path() const {
    auto numbers = numbers_below(size());
    std::ranges::stable_sort(numbers, path_less, [&](std::size_t number) { return path(number); });
    return numbers;
}

std::vector<std::size_t> LogList::by_flight() const {
    auto numbers = numbers_below(size());
    std::ranges::stable_sort(numbers, {}, [&](std::size_t number) { return flight(number); });
    return numbers;
}

bool path_less(std::string_view one, std::string_view other) {
    const bool is_one_whole = one.starts_with('/');
    const bool is_other_whole = other.starts_with('/');
    if (is_one_whole != is_other_whole) return is_other_whole;
    // The end of a part comes before whatever could go on there.
    const auto rank = [](char c) { return c == '/' ? 0 : 1 + static_cast<unsigned char>(c); };
    return std::ranges::lexicographical_compare(one, other, {}, rank, rank);
}

}  // namespace flightwatt::batch
