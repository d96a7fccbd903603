#include "path/coverage/survey_cells.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

constexpr double shortest_piece_m = 1.0;

bool overlap(const LinePart& a, const LinePart& b) {
    return std::min(a.to_m, b.to_m) - std::max(a.from_m, b.from_m) > 0.0;
}

/// Returns what is left of the parts of a line without others.
std::vector<LinePart> without(std::vector<LinePart> parts, const std::vector<LinePart>& removed) {
    for (const auto& gap : removed) {
        std::vector<LinePart> left;
        for (const auto& part : parts) {
            if (overlap(part, gap)) {
                left.push_back({part.from_m, gap.from_m});
                left.push_back({gap.to_m, part.to_m});
            } else {
                left.push_back(part);
            }
        }
        parts = std::move(left);
    }
    std::erase_if(parts, [](const LinePart& part) { return part.to_m - part.from_m < shortest_piece_m; });
    return parts;
}

/// A piece of the line before, and the cell that it belongs to.
struct LastPiece {
    LinePart part;
    std::size_t cell = 0;
};

/// Returns the piece of the line before that is next to a piece, where no other piece is next to either.
const LastPiece* only_neighbour(const LinePart& piece, const std::vector<LinePart>& pieces,
                                const std::vector<LastPiece>& last) {
    const auto is_next_to = [&](const LastPiece& other) { return overlap(other.part, piece); };
    if (std::ranges::count_if(last, is_next_to) != 1) return nullptr;
    const auto& neighbour = *std::ranges::find_if(last, is_next_to);
    const auto shared = [&](const LinePart& other) { return overlap(other, neighbour.part); };
    return std::ranges::count_if(pieces, shared) == 1 ? &neighbour : nullptr;
}

/// Appends the cells of one area.
void add_cells(const Polygon& area, const ClosedZones& closed, double spacing_m, double course_deg,
               std::vector<SurveyCell>& cells) {
    const auto across = [&](const LocalPosition& corner) { return along_and_across(corner, course_deg).across_m; };
    const auto [left, right] = std::ranges::minmax(area, {}, across);
    const double first_m = across(left) + spacing_m / 2.0;
    const double count = std::floor((across(right) + 1e-6 - first_m) / spacing_m) + 1.0;
    std::vector<LastPiece> last;
    for (double line = 0.0; line < count && count <= max_survey_lines; line += 1.0) {
        const double offset_m = first_m + line * spacing_m;
        const auto pieces =
            without(parts_within(area, course_deg, offset_m), closed.parts_of_line(course_deg, offset_m));
        std::vector<LastPiece> now;
        for (const auto& piece : pieces) {
            const auto* neighbour = only_neighbour(piece, pieces, last);
            now.push_back({piece, neighbour != nullptr ? neighbour->cell : cells.size()});
            if (neighbour == nullptr) cells.emplace_back();
            const auto place = [&](double along_m) { return place_at({along_m, offset_m}, course_deg); };
            cells[now.back().cell].push_back({place(piece.from_m), place(piece.to_m)});
        }
        last = std::move(now);
    }
}

/// Returns the distance to the nearest end of a cell's first and last line.
double distance_to_cell_m(const LocalPosition& at, const SurveyCell& cell) {
    return std::min({distance_between_m(at, cell.front().from), distance_between_m(at, cell.front().to),
                     distance_between_m(at, cell.back().from), distance_between_m(at, cell.back().to)});
}

/// Returns whether the turn from the end of a line to the next line, and the straight ways before and after it, are
/// outside of the zones: those of the frame around them.
bool is_open(const ClosedZones& zones, const SurveyLine& before, const LocalPosition& to, double spacing_m) {
    const double course_deg = course_between(before.from, before.to);
    const auto [ahead_m, right_m] = along_and_across(to - before.to, course_deg);
    const auto end = moved(before.to, std::max(ahead_m, 0.0), course_deg);
    const auto beyond = moved(end, spacing_m / 2.0, course_deg);
    const auto abeam = moved(beyond, right_m, course_deg + 90.0);
    return !zones.are_crossed(before.to, beyond) && !zones.are_crossed(beyond, abeam) && !zones.are_crossed(abeam, to);
}

}  // namespace

std::vector<SurveyCell> survey_cells(const std::vector<Polygon>& areas, const ClosedZones& closed, double spacing_m,
                                     double course_deg, const Location& where) {
    std::vector<SurveyCell> cells;
    for (const auto& area : areas) {
        const auto before = cells.size();
        add_cells(area, closed, spacing_m, course_deg, cells);
        if (cells.size() == before)
            throw InputError(
                where, fmt::format("no lines {} m apart fit into the area, or more than 5000; state another spacing",
                                   spacing_m));
    }
    return cells;
}

bool is_divided(const SurveyedArea& area, double spacing_m, double course_deg, const Location& where) {
    return !area.closed.empty() ||
           survey_cells(area.areas, ClosedZones({}, 0.0), spacing_m, course_deg, where).size() > 1;
}

double open_area_m2(const SurveyedArea& area, double course_deg) {
    constexpr int slices = 400;
    const ClosedZones zones(area.closed, 0.0);
    double area_m2 = 0.0;
    for (const auto& polygon : area.areas) {
        const auto across = [&](const LocalPosition& corner) { return along_and_across(corner, course_deg).across_m; };
        const auto [left, right] = std::ranges::minmax(polygon, {}, across);
        const double width_m = (across(right) - across(left)) / slices;
        for (int i = 0; i < slices; ++i) {
            const double offset_m = across(left) + (i + 0.5) * width_m;
            const auto parts = parts_within(polygon, course_deg, offset_m);
            for (const auto& part : without(parts, zones.parts_of_line(course_deg, offset_m)))
                area_m2 += width_m * (part.to_m - part.from_m);
        }
    }
    return area_m2;
}

std::vector<SurveyLine> write_area_survey(const PatternWriter& writer, const SurveyedArea& area, double spacing_m,
                                          double course_deg, const std::optional<LocalPosition>& start) {
    const ClosedZones kept_away(area.closed, spacing_m / 2.0);
    const ClosedZones zones(area.closed, 0.0);
    auto cells = survey_cells(area.areas, kept_away, spacing_m, course_deg, writer.like.where);
    auto at = area.areas.front().front();
    auto named = writer.entries.size();  // the entries of a line and of the way to it have its number
    std::vector<SurveyLine> flown;
    while (!cells.empty()) {
        const auto cell =
            std::ranges::min_element(cells, {}, [&](const auto& one) { return distance_to_cell_m(at, one); });
        if (begins_with_last(*cell, at)) std::ranges::reverse(*cell);
        const auto lines = alternating(std::move(*cell), at);
        cells.erase(cell);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (i > 0 && is_open(zones, lines[i - 1], lines[i].from, spacing_m)) {
                writer.turn_onto(lines[i - 1], lines[i].from, spacing_m);
            } else if (!flown.empty() || start) {
                const auto from = flown.empty() ? *start : at;
                auto way = kept_away.way_around(from, lines[i].from);
                if (!way) way = zones.way_around(from, lines[i].from);  // from a place that is nearer
                if (!way && !flown.empty())
                    throw InputError(writer.like.where, "its zones that are not flown over enclose a part of it");
                for (const auto& corner : way.value_or(std::vector<LocalPosition>{})) writer.fly_to(corner);
            }
            writer.fly_to(lines[i].from);
            writer.fly_to(lines[i].to);
            flown.push_back(lines[i]);
            at = lines[i].to;
            for (; named < writer.entries.size(); ++named) {
                writer.entries[named].name += fmt::format(" (line {})", flown.size());
                writer.entries[named].survey_line = flown.size();
            }
        }
    }
    return flown;
}

}  // namespace flightwatt::path
