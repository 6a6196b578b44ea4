#pragma once
/// The files of cli/view/, as text: cmake/noether_embed.cmake puts them into the program.

namespace noether {

const char*
view_page_text() noexcept;  ///< page.html, with @TITLE@, @STYLE@, @SCRIPT@, @ABOUT@ and @FRAMES@ to be filled
const char* view_style_text() noexcept;   ///< view.css
const char* view_script_text() noexcept;  ///< the scripts, one after the other

}  // namespace noether
