// Names and lines of text from outside: what is taken, what is shown.

#include "numbers/text.hpp"
#include "engine/particle_system.hpp"
#include "tests/support/catch.hpp"

#include <string>

namespace noether::test {
namespace {

TEST_CASE("a name is printable UTF-8", "[text]") {
  for (const char* good : {"Sun", "C 14", "'", "\xC3\x96pik", "\xE2\x98\x89", "\xF0\x9F\xAA\x90"}) {
    CHECK(wrong_name(good).empty());
  }
  CHECK(wrong_name("") == "the name is empty");
  CHECK(wrong_name("a\nb") ==
        "the name 'a\\nb' contains the control character \\n; only printable characters are allowed");
  CHECK(wrong_name(std::string("a\0b", 3)) ==
        "the name 'a\\u0000b' contains the control character \\u0000; only printable characters are allowed");
  CHECK(wrong_name("a\x7F").find("control character \\u007f") != std::string::npos);
  CHECK(wrong_name("a\xC2\x9B").find("control character \\u009b") != std::string::npos);
  CHECK(wrong_name("a\xE2\x80\xA8").find("control character \\u2028") != std::string::npos);
  CHECK(wrong_name("S\xF6l") ==
        "the name 'S\\xf6l' contains the byte \\xf6, which is not UTF-8; save the text as UTF-8");
}

TEST_CASE("a text is cut between characters", "[text]") {
  CHECK(first_characters("abc", 2) == "ab");
  CHECK(first_characters("abc", 9) == "abc");
  CHECK(first_characters("abc", 0).empty());
  CHECK(first_characters("\xC3\x96pik", 1) == "\xC3\x96");
  CHECK(first_characters("a\xF0\x9F\xAA\x90z", 2) == "a\xF0\x9F\xAA\x90");
  CHECK(first_characters("\xF6l", 1) == "\xF6");
}

TEST_CASE("what only looks like UTF-8 is told apart", "[text]") {
  CHECK(is_utf8("plain"));
  CHECK(is_utf8("\xF4\x8F\xBF\xBF"));
  for (const char* bad : {"\x80", "\xC0\xAF", "\xC3", "\xC3(", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80",
                          "\xF8\x88\x80\x80\x80", "\xF0\x9F\xAA", "\xFF"}) {
    INFO(escaped(bad));
    CHECK_FALSE(is_utf8(bad));
  }
  CHECK(valid_utf8("a\xFF\xC3\xB6\xC3") == "a\xEF\xBF\xBD\xC3\xB6\xEF\xBF\xBD");
  CHECK(is_utf8(valid_utf8("\xED\xA0\x80\xF8")));
}

TEST_CASE("text that is shown keeps to its line", "[text]") {
  CHECK(escaped("a\r\n\tb\x1B[0m\xFF\xC3\xB6") == "a\\r\\n\\tb\\u001b[0m\\xff\xC3\xB6");
  CHECK(plain_line("a\nb\x1B c\xFF") == "a b  c\xEF\xBF\xBD");
}

TEST_CASE("ids run from 0 to 2^53", "[particles]") {
  ParticleSystem<double> s;
  s.add("one", 1, {0, 0, 0}, {0, 0, 0});
  s.restore_ids({ParticleSystem<double>::largest_id});
  CHECK(s.next_id() == 9007199254740993);
  CHECK_THROWS_WITH(s.restore_ids({9223372036854775807}),
                    "the id 9223372036854775807 cannot be stored; 0 to 9007199254740992 (2^53) is expected");
  CHECK_THROWS_WITH(s.restore_ids({-1}), "the id -1 cannot be stored; 0 to 9007199254740992 (2^53) is expected");
  CHECK(s.ids().front() == ParticleSystem<double>::largest_id);
}

}  // namespace
}  // namespace noether::test
