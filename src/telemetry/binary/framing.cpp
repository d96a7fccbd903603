#include "telemetry/binary/framing.h"

#include "telemetry/binary/frame_scanner.h"

#include <cstddef>
#include <cstring>

namespace flightwatt::telemetry {
namespace {

/// Calls on_frame(frame, whether it stands right behind another) for all frames with right checksums, one after the
/// other, until it returns false.
template <Framing framing, typename OnFrame>
void for_each_frame(std::string_view bytes, OnFrame&& on_frame) {
    Frame frame;
    const char* p = bytes.data();
    const char* const end = p + bytes.size();
    const char* last_end = nullptr;
    while (p < end) {
        const void* const next = std::memchr(p, sync_byte(framing), static_cast<std::size_t>(end - p));
        if (next == nullptr) return;
        p = static_cast<const char*>(next);
        if (parse_frame<framing>(p, end, frame) != ParseStatus::frame) {
            ++p;
            continue;
        }
        const bool follows = p == last_end;
        p += frame.size;
        last_end = p;
        if (!on_frame(static_cast<const Frame&>(frame), follows)) return;
    }
}

struct FramedBytes {
    std::size_t in_chains = 0;  ///< of frames that follow another
    std::size_t followers = 0;
    std::size_t all = 0;
};

template <Framing framing>
FramedBytes framed_bytes(std::string_view bytes) {
    FramedBytes framed;
    for_each_frame<framing>(bytes, [&](const Frame& frame, bool follows) {
        framed.all += frame.size;
        if (follows) {
            framed.in_chains += frame.size;
            ++framed.followers;
        }
        constexpr std::size_t enough = 1000;
        return framed.followers < enough;
    });
    return framed;
}

}  // namespace

std::optional<Framing> detect_framing(std::string_view bytes, bool is_whole) {
    // Right checksums by chance: two of them one behind the other once in 4 billion bytes.
    constexpr std::size_t min_followers = 2;
    const auto filled = bytes.find_last_not_of('\0') + 1;
    std::optional<Framing> best;
    std::size_t most = 0;
    for (const auto framing : {Framing::card, Framing::link, Framing::xbee}) {
        const auto framed = with_framing(framing, [&]<Framing f>() { return framed_bytes<f>(bytes); });
        std::size_t score = framed.followers >= min_followers ? framed.in_chains : 0;
        constexpr std::size_t nearly = 10;  // all but a tenth
        if (score == 0 && is_whole && framed.all > filled - filled / nearly) score = framed.all;
        if (score > most) {
            most = score;
            best = framing;
        }
    }
    return best;
}

std::optional<LinkVersion> detect_version(std::string_view bytes, Framing framing,
                                          const MessageDictionary& dictionary) {
    constexpr std::size_t enough = 4000;
    std::size_t fit_v1 = 0;
    std::size_t fit_v2 = 0;
    std::size_t frames = 0;
    with_framing(framing, [&]<Framing f>() {
        for_each_frame<f>(bytes, [&](const Frame& frame, bool /*follows*/) {
            fit_v1 += read_message_header(frame, LinkVersion::v1, dictionary).length_matches ? 1 : 0;
            fit_v2 += read_message_header(frame, LinkVersion::v2, dictionary).length_matches ? 1 : 0;
            return ++frames < enough;
        });
    });
    if (fit_v1 == fit_v2) return std::nullopt;
    return fit_v1 > fit_v2 ? LinkVersion::v1 : LinkVersion::v2;
}

}  // namespace flightwatt::telemetry
