#include "uplift/cli/words.h"

#include "uplift/base/text.h"
#include "uplift/io/text/toml.h"

namespace uplift::cli {

std::pair<std::string, Raw> word_of(const std::string& word, const std::string& place) {
  const std::size_t sign = word.find('=');
  if (sign == 0 || sign == std::string::npos) throw InputError({place, 0}, "", "KEY=VALUE", in_quotes(word));
  if (word.find('\n') != std::string::npos) throw InputError({place, 0}, "", "KEY=VALUE on one line", in_quotes(word));
  const std::string key(trim(word.substr(0, sign))), text(trim(word.substr(sign + 1)));
  Raw value{text, {place, 0}, key};
  try {
    const Raw read = read_toml_text(escaped(key) + " = " + text, place);
    if (const Raw* found = std::get<std::shared_ptr<RawTable>>(read.data)->find(key)) value.data = found->data;
  } catch (const InputError&) {
    value.data = text;  // `0.3 g_n`, `vertical`
  }
  return {key, value};
}

Raw table_of(Words words, const std::string& place) {
  return {std::make_shared<RawTable>(RawTable{std::move(words)}), {place, 0}, ""};
}

void refuse_twice(const Words& words, const std::string& place) {
  for (std::size_t i = 0; i < words.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (words[i].first == words[j].first) throw InputError({place, 0}, words[i].first, "one value", "two");
}

}  // namespace uplift::cli
