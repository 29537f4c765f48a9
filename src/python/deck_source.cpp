#include <python/deck_source.hpp>
#include <deck/text/sources.hpp>
#include <algorithm>
#include <fmt/format.h>

namespace whirl::python {

DeckSource::DeckSource(std::string text, std::string name, std::filesystem::path folder)
    : text_(std::move(text)),
      name_(std::move(name)),
      folder_(std::move(folder)) {}

DeckSource DeckSource::from_file(const std::filesystem::path& file) {
  deck::FileText read = deck::read_file(file, deck::max_deck_bytes);
  if (read.ok()) return DeckSource(std::move(read.text), file.string(), file.parent_path());
  Diagnostic d;
  d.code = read.code;
  d.message = read.message;
  d.hint = read.hint;
  d.where.file = file.string();
  throw Error(Exit::io, std::move(d));
}

void DeckSource::set(const std::string& path, const std::string& value) {
  read_.reset();
  const auto same = [&path](const auto& s) { return s.first == path; };
  const auto known = std::find_if(settings_.begin(), settings_.end(), same);
  if (known != settings_.end())
    known->second = value;
  else
    settings_.emplace_back(path, value);
}

std::vector<std::string> DeckSource::settings() const {
  std::vector<std::string> out;
  for (const auto& [path, value] : settings_)
    out.push_back(fmt::format("{}={}", path, value));
  return out;
}

deck::Deck DeckSource::read_with(const std::vector<std::string>& more) const {
  deck::ReadOptions options;
  options.set = settings();
  options.set.insert(options.set.end(), more.begin(), more.end());
  return deck::read_deck_text(text_, name_, options, folder_);
}

std::shared_ptr<const deck::Deck> DeckSource::read() const {
  if (read_) return read_;
  auto deck = std::make_shared<deck::Deck>(read_with({}));
  if (!deck->ok()) throw Error(deck::exit_of(deck->diagnostics), deck->diagnostics);
  read_ = std::move(deck);
  return read_;
}

model::Model DeckSource::model_with(const std::vector<std::string>& more) const {
  deck::Deck deck = read_with(more);
  if (!deck.ok()) throw Error(deck::exit_of(deck.diagnostics), std::move(deck.diagnostics));
  return std::move(deck.model);
}

std::string DeckSource::shown(const std::vector<Diagnostic>& diagnostics) const {
  deck::Sources sources;
  sources.add(name_, folder_, text_);
  std::string out;
  for (const Diagnostic& d : diagnostics)
    out += format(d, sources.line(d.where));
  return out;
}

}  // namespace whirl::python
