#include "telemetry/binary/frame.h"

#include <cstring>

namespace flightwatt::telemetry {
namespace {

/// Calls on_frame(frame, whether it directly follows another) for all frames with valid checksums, in order, until it
/// returns false.
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

/// Reads the bytes of a frame, one after the other.
class PacketReader {
  public:
    PacketReader(const char* p, const char* end, bool escaped) : p_(p), end_(end), escaped_(escaped) {}

    /// std::nullopt at the end, and for a byte that an escaped frame cannot contain.
    std::optional<std::uint8_t> next() {
        constexpr std::uint8_t escape = 0x7D;
        if (p_ == end_) return std::nullopt;
        auto byte = byte_at(p_++);
        if (!escaped_) return byte;
        if (byte == 0x7E) return refuse();
        if (byte != escape) return byte;
        if (p_ == end_) return std::nullopt;
        byte = byte_at(p_++);
        if (byte == 0x7E) return refuse();
        return static_cast<std::uint8_t>(byte ^ 0x20);
    }
    bool is_refused() const { return refused_; }
    const char* position() const { return p_; }

  private:
    std::nullopt_t refuse() {
        refused_ = true;
        return std::nullopt;
    }

    const char* p_;
    const char* end_;
    bool escaped_;
    bool refused_ = false;
};

/// Size of the header before the message, by the type of packet: 0x80 from a 64-bit address, 0x81 from a 16-bit one,
/// 0x90 of later series; 0 for any other.
std::size_t header_of(std::uint8_t kind) {
    switch (kind) {
        case 0x80:
            return 11;
        case 0x81:
            return 5;
        case 0x90:
            return 12;
        default:
            return 0;
    }
}

}  // namespace

std::optional<Framing> detect_framing(std::string_view bytes, bool is_whole) {
    // Two consecutive checksums are valid by chance once in 4 billion bytes.
    constexpr std::size_t min_followers = 2;
    const auto filled = bytes.find_last_not_of('\0') + 1;
    std::optional<Framing> best;
    std::size_t max_score = 0;
    for (const auto framing : {Framing::card, Framing::link, Framing::xbee}) {
        const auto framed = with_framing(framing, [&]<Framing f>() { return framed_bytes<f>(bytes); });
        std::size_t score = framed.followers >= min_followers ? framed.in_chains : 0;
        constexpr std::size_t nearly = 10;  // all but a tenth
        if (score == 0 && is_whole && framed.all > filled - filled / nearly) score = framed.all;
        if (score > max_score) {
            max_score = score;
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

ParseStatus parse_xbee_frame(const char* p, const char* end, bool escaped, Frame& frame) {
    PacketReader reader(p + 1, end, escaped);
    const auto stopped = [&] { return reader.is_refused() ? ParseStatus::none : ParseStatus::incomplete; };
    const auto high = reader.next();
    const auto low = high ? reader.next() : std::nullopt;
    if (!low) return stopped();
    const auto length = *high * std::size_t{256} + *low;
    if (length < 2 || length > frame.unescaped.size()) return ParseStatus::none;
    if (!escaped && static_cast<std::size_t>(end - reader.position()) < length + 1) return ParseStatus::incomplete;
    const char* const data = reader.position();
    std::uint8_t sum = 0;
    for (std::size_t i = 0; i <= length; ++i) {
        const auto byte = reader.next();
        if (!byte) return stopped();
        sum = static_cast<std::uint8_t>(sum + *byte);
        if (escaped && i < length) frame.unescaped[i] = static_cast<char>(*byte);
    }
    if (sum != 0xFF) return ParseStatus::none;
    const std::string_view packet(escaped ? frame.unescaped.data() : data, length);
    const auto header = header_of(byte_at(packet.data()));
    frame.size = static_cast<std::size_t>(reader.position() - p);
    frame.message = header == 0 || packet.size() < header ? std::string_view() : packet.substr(header);
    frame.source = 0;
    return ParseStatus::frame;
}

ParseStatus parse_any_xbee_frame(const char* p, const char* end, Frame& frame) {
    const auto is_followed = [&](const Frame& read) {
        return p + read.size == end || p[read.size] == sync_byte(Framing::xbee);
    };
    const auto plain = parse_xbee_frame(p, end, false, frame);
    const bool is_plain = plain == ParseStatus::frame && is_followed(frame);
    const auto plain_size = frame.size;
    const auto escaped = parse_xbee_frame(p, end, true, frame);
    if (escaped == ParseStatus::frame &&
        (plain != ParseStatus::frame || (is_followed(frame) && (!is_plain || frame.size < plain_size))))
        return escaped;
    if (plain == ParseStatus::frame) return parse_xbee_frame(p, end, false, frame);
    return escaped == ParseStatus::none ? plain : escaped;
}

}  // namespace flightwatt::telemetry
