#pragma once

#include "telemetry/binary/frame.h"
#include "telemetry/message_dictionary.h"

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace flightwatt::telemetry {

/// A frame that is taken for one that was sent, and what its message is by the definitions.
struct FoundFrame {
    std::size_t offset = 0;  ///< of its first byte, from the first that was scanned
    std::uint8_t sender = 0;
    std::uint8_t class_id = 0;
    std::uint8_t id = 0;
    bool carries_message = false;
    std::string_view fields;
    const WireMessage* message = nullptr;  ///< nullptr: not defined
    bool fits = false;                     ///< the fields have the length that is defined
};

/// Bytes between frames.
struct Gap {
    std::size_t offset = 0;
    std::size_t bytes = 0;
    std::size_t zeros = 0;    ///< at its end: room that was set aside, not damage
    bool is_cut_off = false;  ///< begins where a frame should, of which there is too little
};

/// What header and fields are; without a message where there are too few bytes for the header. Of every frame, and short:
/// a call and a copy of the result would be a tenth of the time that a log takes.
[[gnu::always_inline]] inline FoundFrame read_message_header(const Frame& frame, LinkVersion version,
                                                             const MessageDictionary& dictionary) {
    FoundFrame found;
    const auto& bytes = frame.message;
    const std::size_t header = version == LinkVersion::v1 ? 2 : 4;
    if (bytes.size() < header) return found;
    found.carries_message = true;
    found.sender = byte_at(bytes.data());
    if (version == LinkVersion::v1) {
        found.class_id = frame.source == 1 ? MessageDictionary::datalink_class : MessageDictionary::telemetry_class;
    } else {
        found.class_id = byte_at(bytes.data() + 2) & 0xF;  // the high bits are the component
    }
    found.id = byte_at(bytes.data() + header - 1);
    found.fields = {bytes.data() + header, bytes.size() - header};
    found.message = dictionary.find(found.class_id, found.id);
    found.fits = found.message != nullptr && found.message->fits(found.fields);
    return found;
}

/// What comes behind the bytes that are scanned.
enum class Behind {
    more,   ///< more bytes, at once
    pause,  ///< more may come
    end,
};

/// Frames out of bytes, also damaged ones (docs/formats.md, "Damage"). A frame whose checksum is right and whose message
/// fits its definition counts; where the next frame does not follow, only if none that fits begins within it. One that
/// does not fit counts if none that fits begins within it and it stands where a frame should, or one follows, or its
/// sender is known. So a damaged length cannot swallow the frames behind it.
template <Framing framing>
class FrameScanner {
  public:
    /// Without a version that of most frames so far is taken that fit one alone. `dictionary` is kept.
    FrameScanner(const MessageDictionary& dictionary, std::optional<LinkVersion> version)
        : dictionary_(&dictionary), version_(version) {}

    std::optional<LinkVersion> version() const { return version_ ? version_ : likely_version(); }

    /// Calls on_frame(FoundFrame, Frame) and on_gap(Gap) in the order of the bytes; a gap is told with the frame behind
    /// it, or at the end. Returns how many bytes are done with: the others are to be given again, with more behind them.
    template <typename OnFrame, typename OnGap>
    std::size_t scan(std::string_view bytes, Behind behind, OnFrame&& on_frame, OnGap&& on_gap) {
        begin_ = bytes.data();
        end_ = begin_ + bytes.size();
        searched_ = begin_;
        fitting_ = nullptr;
        const char* p = begin_;
        while (p < end_) {
            if (*p != sync_byte(framing)) {
                const void* const next = std::memchr(p, sync_byte(framing), static_cast<std::size_t>(end_ - p));
                const char* const stop = next == nullptr ? end_ : static_cast<const char*>(next);
                skip(p, stop, false);
                p = stop;
                continue;
            }
            const auto look = look_at(p, frame_);
            if (look == Look::incomplete && behind != Behind::end && !fitting_begins_in(p + 1, end_)) break;
            if (look == Look::frame) {
                const char* const stop = p + frame_.size;
                auto found = read(frame_, true);
                const bool is_sure = found.fits && two_seem_to_begin<framing>(stop, end_);
                const auto verdict = is_sure ? Verdict::count : judge(found, p, stop, behind);
                if (verdict == Verdict::wait) break;
                if (verdict != Verdict::reject) {
                    close_gap(on_gap);
                    found.offset = offset_of(p);
                    in_step_ = true;
                    if (found.fits) known_senders_.set(found.sender);
                    on_frame(static_cast<const FoundFrame&>(found), static_cast<const Frame&>(frame_));
                    p = verdict == Verdict::count ? stop : fitting_;
                    continue;
                }
            }
            skip(p, p + 1, look == Look::incomplete);
            ++p;
        }
        const auto done = static_cast<std::size_t>(p - begin_);
        offset_ += done;
        if (behind == Behind::end) close_gap(on_gap);
        return done;
    }

  private:
    enum class Verdict { count, count_both, reject, wait };

    Verdict judge(const FoundFrame& found, const char* p, const char* stop, Behind behind) {
        const bool is_last = stop == end_;
        if (is_last && (behind == Behind::more || (behind == Behind::pause && !found.fits))) return Verdict::wait;
        const bool is_followed = is_last || *stop == sync_byte(framing);
        if (found.fits && is_last) return Verdict::count;
        if (found.fits && is_followed) {
            const auto next = look_at(stop, inner_);
            if (next == Look::incomplete && behind == Behind::more) return Verdict::wait;
            if (next == Look::frame || (next == Look::incomplete && behind == Behind::pause)) return Verdict::count;
        }
        if (fitting_begins_in(p + 1, stop)) {
            // Of a frame that has lost its last byte, and of one that has lost its first, the neighbour may stand in for
            // it: both were sent, and which of them is damaged cannot be told.
            return found.fits && fitting_ >= stop - checksum_bytes(framing) ? Verdict::count_both : Verdict::reject;
        }
        const bool counts = found.fits || in_step_ || is_followed || known_senders_.test(found.sender);
        return counts ? Verdict::count : Verdict::reject;
    }

    /// Of an XBee's packet that has a right checksum both as it stands and escaped, the one whose message fits.
    Look look_at(const char* p, Frame& frame) {
        const auto look = look_at_frame<framing>(p, end_, frame);
        if constexpr (framing == Framing::xbee) {
            if (look != Look::frame || read(frame, false).fits) return look;
            for (const bool escaped : {false, true}) {
                if (look_at_xbee_frame(p, end_, escaped, other_) != Look::frame || !read(other_, false).fits) continue;
                return look_at_xbee_frame(p, end_, escaped, frame);
            }
        }
        return look;
    }

    /// `counts`: whether the frame tells which version this is.
    FoundFrame read(const Frame& frame, bool counts) {
        return version_ ? read_message_header(frame, *version_, *dictionary_) : read_of_any_version(frame, counts);
    }

    FoundFrame read_of_any_version(const Frame& frame, bool counts) {
        const auto v1 = read_message_header(frame, LinkVersion::v1, *dictionary_);
        const auto v2 = read_message_header(frame, LinkVersion::v2, *dictionary_);
        if (counts && v1.fits != v2.fits) ++(v1.fits ? fit_v1_ : fit_v2_);
        if (const auto likely = likely_version()) return *likely == LinkVersion::v1 ? v1 : v2;
        if (v1.fits && (!v2.fits || v2.class_id != MessageDictionary::telemetry_class)) return v1;
        if (v2.fits && !v1.fits) return v2;
        FoundFrame undecided = v1;
        undecided.message = nullptr;
        undecided.fits = false;
        return undecided;
    }

    std::optional<LinkVersion> likely_version() const {
        if (fit_v1_ == fit_v2_) return std::nullopt;
        return fit_v1_ > fit_v2_ ? LinkVersion::v1 : LinkVersion::v2;
    }

    /// Whether a frame that fits begins in [from, to). Each byte is looked at once.
    bool fitting_begins_in(const char* from, const char* to) {
        if (fitting_ != nullptr && fitting_ >= from) return fitting_ < to;
        fitting_ = nullptr;
        for (const char* p = std::max(from, searched_); p < to; ++p) {
            const void* const next = std::memchr(p, sync_byte(framing), static_cast<std::size_t>(to - p));
            if (next == nullptr) break;
            p = static_cast<const char*>(next);
            if (look_at(p, inner_) != Look::frame || !read(inner_, false).fits) continue;
            fitting_ = p;
            searched_ = p + 1;
            return true;
        }
        searched_ = std::max(searched_, to);
        return false;
    }

    std::size_t offset_of(const char* p) const { return offset_ + static_cast<std::size_t>(p - begin_); }

    void skip(const char* from, const char* to, bool is_incomplete) {
        if (gap_.bytes == 0) gap_ = {offset_of(from), 0, 0, in_step_ && is_incomplete};
        in_step_ = false;
        const auto bytes = static_cast<std::size_t>(to - from);
        std::size_t zeros = 0;
        while (zeros < bytes && to[-1 - static_cast<std::ptrdiff_t>(zeros)] == '\0') ++zeros;
        gap_.zeros = zeros == bytes ? gap_.zeros + zeros : zeros;
        gap_.bytes += bytes;
    }

    template <typename OnGap>
    void close_gap(OnGap&& on_gap) {
        if (gap_.bytes > 0) on_gap(static_cast<const Gap&>(gap_));
        gap_ = {};
    }

    const MessageDictionary* dictionary_;
    std::optional<LinkVersion> version_;
    std::size_t fit_v1_ = 0;
    std::size_t fit_v2_ = 0;
    std::bitset<256> known_senders_;
    bool in_step_ = true;  ///< the last frame ended where the next byte is
    Gap gap_;
    std::size_t offset_ = 0;  ///< of begin_
    const char* begin_ = nullptr;
    const char* end_ = nullptr;
    const char* searched_ = nullptr;  ///< up to here no frame that fits begins, but
    const char* fitting_ = nullptr;   ///< this one
    Frame frame_;
    Frame inner_;
    Frame other_;
};

}  // namespace flightwatt::telemetry
