// SPDX-License-Identifier: MIT
#include "saved/SavedXml.h"

#include "text/FileText.h"

#include <osgSkin/Error>

#include <algorithm>
#include <utility>

namespace osgSkin {
namespace {

/// OSG's own entities; it knows no others.
std::string decoded(const std::string& text) {
    static const std::pair<const char*, char> entities[] = {{"&amp;", '&'},   {"&lt;", '<'},
                                                            {"&gt;", '>'},    {"&quot;", '"'},
                                                            {"&apos;", '\''}, {"&nl;", '\n'}};
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t size = 0;
        for (const auto& [entity, letter] : entities)
            if (size == 0 &&
                text.compare(at, std::char_traits<char>::length(entity), entity) == 0) {
                result.push_back(letter);
                size = std::char_traits<char>::length(entity);
            }
        if (size == 0) result.push_back(text[at++]);
        at += size;
    }
    return result;
}

/// A class's `::` is no part of an element's name.
std::string className(std::string name) {
    const std::size_t sign = name.find("--");
    if (sign != std::string::npos) name.replace(sign, 2, "::");
    return name;
}

} // namespace

void SavedXml::skipPast(const char* end) {
    const std::size_t found = _content.find(end, _at);
    if (found == std::string::npos) refuse("it ends too early");
    _at = found + std::char_traits<char>::length(end);
}

std::string SavedXml::takeName() {
    skipSpace();
    const std::size_t end =
        std::min(_content.find_first_of(" \t\r\n=/><\"'", _at), _content.size());
    std::string name = _content.substr(_at, end - _at);
    _at = end;
    skipSpace();
    return name;
}

std::string SavedXml::takeValue() {
    const char quote = _at < _content.size() ? _content[_at] : '\0';
    if (quote != '"' && quote != '\'') refuse("an attribute without quotes");
    const std::size_t first = _at + 1;
    const std::size_t end = _content.find(quote, first);
    if (end == std::string::npos) refuse("it ends within an attribute");
    _at = end + 1;
    return decoded(_content.substr(first, end - first));
}

void SavedXml::skipSpace() {
    _at = std::min(_content.find_first_not_of(kSpace, _at), _content.size());
}

/// Whether what comes next stands in the element that is read, or closes it.
bool SavedXml::isAtEnd() {
    for (;;) {
        const bool isLast = !_scopes.empty() && _depth == _scopes.back();
        if (_isClosed) {
            if (isLast) return true;
            _isClosed = false;
            --_depth;
            continue;
        }
        const std::size_t tag = _content.find('<', _at);
        if (tag == std::string::npos) return true;
        _at = tag;
        if (_content.compare(tag, 4, "<!--") == 0) {
            skipPast("-->");
        } else if (_content.compare(tag, 2, "</") != 0) {
            return false;
        } else {
            if (isLast) return true;
            skipPast(">");
            if (_depth > 0) --_depth;
        }
    }
}

bool SavedXml::takeElement() {
    if (isAtEnd()) return false;
    skipPast("<");
    _chunk = takeName();
    _next = 0;
    _isName = true;
    ++_depth;
    for (skipSpace(); _at < _content.size() && _content[_at] != '>'; skipSpace()) {
        _isClosed = _content[_at] == '/';
        if (_isClosed) {
            ++_at;
            continue;
        }
        const std::string name = takeName();
        if (name.empty() || _at >= _content.size() || _content[_at] != '=')
            refuse("an element " + inQuotes(_chunk) + " that is not closed");
        ++_at;
        skipSpace();
        const std::string value = takeValue();
        if (name == "attribute") _attribute = value;
        if (name == "text") _text = value;
    }
    return true;
}

/// Leaves the element that the last bracket opened; what nothing has read of it is refused.
void SavedXml::leave() {
    begin();
    if (_scopes.empty()) return;
    const std::size_t depth = _scopes.back();
    const bool isWhole = _scopes.size() < 2 || _scopes[_scopes.size() - 2] != depth;
    if (isWhole && ((_isName && _next < _chunk.size()) || takeElement()))
        refuseWord(nextWord(), "a property of the object at its place");
    _scopes.pop_back();
    if (!isWhole) return; // a bracket within another, in one element
    for (std::string* words : {&_chunk, &_attribute, &_text}) words->clear();
    _next = 0;
    if (!_isClosed) skipPast(">");
    _isClosed = false;
    --_depth;
}

/// OSG has made room for a picture's pixels when it leaves them.
void SavedXml::leavePixels() {
    _isBehindPixels = false;
    try {
        leave();
    } catch (const Error& error) {
        refuseNext(error.what());
    }
}

/// Whether there is something left, which is in the chunk then.
bool SavedXml::prepare() {
    begin();
    while (_chunk.find_first_not_of(kSpace, _next) == std::string::npos) {
        _chunk.clear();
        _next = 0;
        _isName = false;
        if (!_attribute.empty())
            _chunk = std::exchange(_attribute, {});
        else if (!_text.empty())
            _chunk = std::exchange(_text, {});
        else if (!takeElement())
            return false;
    }
    return true;
}

std::string SavedXml::nextWord() {
    if (!prepare()) refuse("it ends too early");
    const std::size_t first = _chunk.find_first_not_of(kSpace, _next);
    _next = std::min(_chunk.find_first_of(kSpace, first), _chunk.size());
    return className(_chunk.substr(first, _next - first));
}

std::string SavedXml::nextName(const std::string& expected) {
    const std::string name = nextWord();
    return expected.compare(0, 1, "#") == 0 ? "#" + name : name; // which no element is called
}

void SavedXml::readMark(osgDB::ObjectMark& mark) {
    if (mark._name == "{") {
        tookBegin();
        _scopes.push_back(_depth);
    } else if (mark._name == "}") {
        _isBehindPixels ? leavePixels() : leave();
    }
}

void SavedXml::readWrappedString(std::string& text) {
    text.clear();
    if (!prepare()) refuse("it ends too early");
    _next = _chunk.find_first_not_of(kSpace, _next);
    const bool quoted = _chunk[_next] == '"';
    if (quoted) ++_next;
    for (; _next < _chunk.size(); ++_next) {
        if (quoted && _chunk[_next] == '"') break;
        if (_chunk[_next] == '\\' && _next + 1 < _chunk.size()) ++_next;
        text.push_back(_chunk[_next]);
    }
    if (_next < _chunk.size()) ++_next;
    const bool isPicture = _image.isOpen();
    text = tookWrapped(text);
    _isBehindPixels = isPicture && !_image.isOpen();
}

bool SavedXml::matchString(const std::string& text) {
    if (!prepare()) return false; // what is asked for last may be missing
    const std::size_t first = _chunk.find_first_not_of(kSpace);
    const std::size_t last = _chunk.find_last_not_of(kSpace);
    if (_chunk.compare(first, last + 1 - first, text) != 0) return false;
    _next = _chunk.size();
    tookMatch(text);
    return true;
}

void SavedXml::finish() {
    begin();
    if (prepare()) refuseWord(nextWord(), "a property of the object at its place");
}

} // namespace osgSkin
