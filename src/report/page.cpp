#include "report/page.h"

#include "base/error.h"
#include "base/input_file.h"
#include "report/document/columns.h"
#include "report/document/plain_answers.h"

#include <boost/algorithm/string/replace.hpp>

namespace flightwatt::report {
namespace {

/// Escapes "</script": in strings and regular expressions, "<\/" is "</".
std::string inline_script(const std::string& text) {
    return "<script>" + boost::replace_all_copy(text, "</script", "<\\/script") + "</script>\n";
}

/// The page web/NAME.html, with each "{{FIELD}}" replaced by its value.
std::string filled_page(std::string_view name, const std::map<std::string_view, std::string_view>& values) {
    auto left = web_pages().at(name);
    std::string html;
    for (auto at = left.find("{{"); at != std::string_view::npos; at = left.find("{{")) {
        const auto end = left.find("}}", at);
        html.append(left.substr(0, at)).append(values.at(left.substr(at + 2, end - at - 2)));
        left.remove_prefix(end + 2);
    }
    html.append(left);
    return html;
}

}  // namespace

std::filesystem::path web_folder() { return data_folder("web", "FLIGHTWATT_WEB", "the report's web files"); }

FrontEnd read_front_end(const std::filesystem::path& folder, const std::string& name) {
    const auto style = folder / (name + ".css");
    const auto script = folder / (name + ".js");
    for (const auto& file : {style, script})
        if (open_error(file))
            throw InputError({file.string()}, "this part of the page is missing",
                             "run scripts/install_dependencies with access to the npm registry, and scripts/build "
                             "release programs");
    return {read_file(style), read_file(script)};
}

std::string read_engine(const std::filesystem::path& folder) {
    const auto file = folder / "flightwatt.wasm.gz";
    if (open_error(file))
        throw InputError({file.string()}, "the program for the page is missing",
                         "run scripts/build_wasm, or leave out --interactive");
    return read_file(file);
}

std::string page_html(const Json& document, const FrontEnd& front_end) {
    const bool has_engine = !front_end.engine.empty();
    const auto engine =
        !has_engine ? ""
                    : "<script type=\"text/plain\" id=\"flightwatt-wasm\">" + base64(front_end.engine) + "</script>\n";
    return filled_page("page", {{"version", FLIGHTWATT_VERSION},
                                {"engine-scripts", has_engine ? " 'wasm-unsafe-eval'" : ""},
                                {"engine-workers", has_engine ? "; worker-src blob:" : ""},
                                {"engine", engine},
                                {"title", html_escaped(document.at("title").get<std::string>())},
                                {"style", front_end.style},
                                {"answers", plain_answers(document)},
                                {"document", script_json(document)},
                                {"script", inline_script(front_end.script)}});
}

std::string script_json(const Json& json) {
    const auto text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return boost::replace_all_copy(text, "<", "\\u003c");  // no </script> and no <!--
}

std::string live_page_html(const FrontEnd& front_end) {
    return filled_page(
        "live",
        {{"version", FLIGHTWATT_VERSION}, {"style", front_end.style}, {"script", inline_script(front_end.script)}});
}

}  // namespace flightwatt::report
