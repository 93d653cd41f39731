// SPDX-License-Identifier: MIT
#include "saved/SavedAscii.h"

#include "text/FileText.h"

#include <osgDB/Registry>

#include <algorithm>

namespace osgSkin {
void SavedAscii::skipSpace() {
    _at = std::min(_content.find_first_not_of(kSpace, _at), _content.size());
}

std::string SavedAscii::nextWord() {
    begin();
    skipSpace();
    const std::size_t end = std::min(_content.find_first_of(kSpace, _at), _content.size());
    std::string word = _content.substr(_at, end - _at);
    _at = end;
    if (word.empty()) refuse("it ends too early");
    _word = word;
    return word;
}

void SavedAscii::readMark(osgDB::ObjectMark& mark) {
    if (mark._name == "{") tookBegin();
    const std::string before = _word;
    const std::string word = nextWord();
    if (word != mark._name) refuse(inQuotes(word) + ", expected " + inQuotes(mark._name));
    if (word == "{") _open.push_back(before);
    if (word == "}" && !_open.empty()) _open.pop_back();
}

void SavedAscii::readWrappedString(std::string& text) {
    text.clear();
    begin();
    skipSpace();
    const bool quoted = _at < _content.size() && _content[_at] == '"';
    if (quoted) ++_at;
    for (;; ++_at) {
        if (_at >= _content.size()) refuse("it ends within a text");
        const char c = _content[_at];
        if (quoted ? c == '"' : c == ' ' || c == '\n') break;
        if (quoted && c == '\\' && _at + 1 < _content.size()) ++_at;
        text.push_back(_content[_at]);
    }
    ++_at;
    const bool isPicture = _image.isOpen();
    text = tookWrapped(text);
    if (isPicture && !_image.isOpen()) expectPixelsEnd();
}

void SavedAscii::expectPixelsEnd() {
    // OSG has made room for them when it looks for their end, and would lose that.
    skipSpace();
    const std::size_t end = std::min(_content.find_first_of(kSpace, _at), _content.size());
    if (_content.compare(_at, end - _at, "}") == 0) return;
    refuse("a picture's pixels that go on, expected \"}\"");
}

bool SavedAscii::matchString(const std::string& text) {
    begin();
    skipSpace();
    const std::size_t end = _at + text.size();
    if (_content.compare(_at, text.size(), text) != 0) return false;
    if (end < _content.size() && std::string(kSpace).find(_content[end]) == std::string::npos)
        return false;
    _at = end;
    tookMatch(text);
    return true;
}

void SavedAscii::advanceToCurrentEndBracket() {
    const std::string ofClass = _open.empty() ? std::string() : _open.back();
    if (!_open.empty()) _open.pop_back();
    for (std::size_t open = 1; open > 0;) {
        const std::string word = nextWord();
        if (word == "{") ++open;
        if (word == "}" && --open == 0) break;
        // A class that nobody knows is left out as a whole, and OSG says so.
        if (open == 1 &&
            osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper(ofClass))
            refuseWord(word, ("a property of " + ofClass + " at its place").c_str());
    }
}

} // namespace osgSkin
