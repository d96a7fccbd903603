#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__AARCH64EL__)
#include <arm_neon.h>
#endif

/// The log reader's inner loop: lines and words of a .data text, 64 bytes at a time, without a copy.
namespace flightwatt::telemetry {

/// Bit i tells of byte i of a block of 64.
struct BlockMasks {
    std::uint64_t blanks;
    std::uint64_t breaks;
};

inline constexpr std::size_t block_size = 64;

/// Blanks and line breaks among the 64 bytes from `p`, all of which must be readable; on any machine.
inline BlockMasks masks_of_bytes(const char* p) {
    BlockMasks masks{0, 0};
    for (unsigned i = 0; i < block_size; ++i) {
        masks.blanks |= std::uint64_t{p[i] == ' '} << i;
        masks.breaks |= std::uint64_t{p[i] == '\n'} << i;
    }
    return masks;
}

/// The same by 16 bytes at a time, where the machine can.
inline BlockMasks masks_of(const char* p) {
#if defined(__SSE2__)
    BlockMasks masks{0, 0};
    const __m128i blank = _mm_set1_epi8(' ');
    const __m128i line_break = _mm_set1_epi8('\n');
    for (unsigned i = 0; i < 4; ++i) {
        __m128i bytes;
        std::memcpy(&bytes, p + std::size_t{16} * i, sizeof bytes);
        const auto bits = [&](__m128i wanted) {
            return static_cast<std::uint64_t>(
                static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_cmpeq_epi8(bytes, wanted))));
        };
        masks.blanks |= bits(blank) << (16 * i);
        masks.breaks |= bits(line_break) << (16 * i);
    }
    return masks;
#elif defined(__AARCH64EL__)
    // Each byte that matches gives the bit of its place among eight; sums of neighbours, three times over, gather them.
    static constexpr std::uint8_t places[16] = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const uint8x16_t place = vld1q_u8(places);
    uint8x16_t bytes[4];
    std::memcpy(bytes, p, sizeof bytes);
    const auto mask_of = [&](char character) {
        const uint8x16_t wanted = vdupq_n_u8(static_cast<std::uint8_t>(character));
        const auto bits = [&](uint8x16_t quarter) { return vandq_u8(vceqq_u8(quarter, wanted), place); };
        const auto halves =
            vpaddq_u8(vpaddq_u8(bits(bytes[0]), bits(bytes[1])), vpaddq_u8(bits(bytes[2]), bits(bytes[3])));
        return vgetq_lane_u64(vreinterpretq_u64_u8(vpaddq_u8(halves, halves)), 0);
    };
    return {mask_of(' '), mask_of('\n')};
#else
    return masks_of_bytes(p);
#endif
}

/// The first line break from `p`, whose bytes up to `block_size` beyond `end` must be readable; `end` or a
/// break beyond it if there is none before.
inline const char* next_break(const char* p, const char* end) {
    for (; p < end; p += block_size) {
        if (const auto breaks = masks_of(p).breaks; breaks != 0) return p + std::countr_zero(breaks);
    }
    return end;
}

/// One line: its text without the line break, its number from 1, and the blanks among its first 64 bytes.
struct ScannedLine {
    const char* begin;
    const char* end;
    std::uint64_t blanks;
    std::size_t number;
};

/// How far past a line's begin the scanner and its callers may read.
inline constexpr std::size_t read_ahead = 2 * block_size;

/// The first eight bytes of a word as a number, zeros behind a shorter one: words of up to eight bytes are
/// equal if these and their sizes are. Eight bytes from the word's begin must be readable.
inline std::uint64_t first_bytes(std::string_view word) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, word.data(), sizeof bytes);
    if (word.size() >= sizeof bytes) return bytes;
    if constexpr (std::endian::native == std::endian::little) {
        return bytes & ((std::uint64_t{1} << (8 * word.size())) - 1);
    } else {
        return word.empty() ? 0 : bytes & ~(~std::uint64_t{0} >> (8 * word.size()));
    }
}

/// Calls on_line(ScannedLine) for every line of [begin, end) whose bytes up to `read_ahead` beyond `end` are
/// readable; the last line may lack its break. Returns the number of the line after the last.
template <typename OnLine>
std::size_t scan_padded_lines(const char* begin, const char* end, std::size_t number, OnLine&& on_line) {
    while (begin < end) {
        const auto masks = masks_of(begin);
        const char* line_end = end;
        std::uint64_t blanks = masks.blanks;
        if (masks.breaks != 0) {
            line_end = begin + std::countr_zero(masks.breaks);
            blanks &= (masks.breaks & (~masks.breaks + 1)) - 1;  // those before the first break
        } else {
            line_end = next_break(begin + block_size, end);
        }
        if (line_end > end) line_end = end;
        on_line(ScannedLine{begin, line_end, blanks, number});
        ++number;
        begin = line_end + 1;
    }
    return number;
}

/// Calls on_line(ScannedLine) for every line of `text`. The end of the text is copied once, so that reading
/// ahead never leaves it. Returns the number of lines.
template <typename OnLine>
std::size_t scan_lines(std::string_view text, OnLine&& on_line) {
    std::size_t whole = 0;  // bytes of lines that can be scanned in place
    if (text.size() > read_ahead) {
        const auto last_break = text.rfind('\n', text.size() - read_ahead);
        if (last_break != std::string_view::npos) whole = last_break + 1;
    }
    const auto number = scan_padded_lines(text.data(), text.data() + whole, 1, on_line);
    std::string tail(text.substr(whole));
    const auto tail_size = tail.size();
    tail.append(read_ahead, '\0');
    return scan_padded_lines(tail.data(), tail.data() + tail_size, number, on_line) - 1;
}

/// The words of a line, one after the other; blanks separate, and several count as one word break each.
class WordCursor {
  public:
    explicit WordCursor(const ScannedLine& line)
        : word_(line.begin), end_(line.end), block_(line.begin), blanks_(line.blanks) {}

    /// The next word; false at the end of the line. A trailing blank opens no word.
    bool next(std::string_view& word) {
        if (word_ >= end_) return false;
        const char* stop = next_blank();
        word = {word_, static_cast<std::size_t>(stop - word_)};
        word_ = stop + 1;
        return true;
    }
    /// Where the next word begins.
    const char* position() const { return word_; }
    /// How many words are left.
    std::size_t words_left() const {
        if (word_ >= end_) return 0;
        std::size_t count = end_[-1] == ' ' ? 0 : 1;
        std::uint64_t blanks = blanks_;
        const char* block = block_;
        for (; end_ - block > static_cast<std::ptrdiff_t>(block_size); blanks = masks_of(block).blanks) {
            count += static_cast<std::size_t>(std::popcount(blanks));
            block += block_size;
        }
        const auto rest = static_cast<unsigned>(block + block_size - end_);
        return count + static_cast<std::size_t>(std::popcount(blanks << rest));
    }
    /// Excludes a carriage return at the end of the line.
    void trim_return() {
        if (word_ < end_ && end_[-1] == '\r') --end_;
    }

  private:
    const char* next_blank() {
        while (blanks_ == 0) {
            block_ += block_size;
            if (block_ >= end_) return end_;
            blanks_ = masks_of(block_).blanks;
        }
        const char* blank = block_ + std::countr_zero(blanks_);
        blanks_ &= blanks_ - 1;
        return blank < end_ ? blank : end_;
    }

    const char* word_;
    const char* end_;
    const char* block_;
    std::uint64_t blanks_;
};

/// The third word of a line, which names the message; without data if the line has not as many.
inline std::string_view third_word(const ScannedLine& line) {
    const auto from_second = line.blanks & (line.blanks - 1);
    const auto from_third = from_second & (from_second - 1);
    if (from_third != 0) {  // nearly always: three blanks among the first 64 bytes
        const auto begin = std::countr_zero(from_second) + 1;
        return {line.begin + begin, static_cast<std::size_t>(std::countr_zero(from_third) - begin)};
    }
    WordCursor words(line);
    std::string_view word;
    if (words.next(word) && words.next(word) && words.next(word)) return word;
    return {};
}

}  // namespace flightwatt::telemetry
