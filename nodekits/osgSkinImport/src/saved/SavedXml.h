// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDXML_H
#define OSGSKINIMPORT_SAVEDXML_H 1

#include "saved/SavedText.h"

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// The layout of `.osgx` files: of each element its name, its attributes `attribute` and `text`,
/// then the elements within it. Brackets, of other files' texts, open and close the element that is
/// read; within one that has no elements they have no meaning.
class SavedXml : public SavedText {
public:
    using SavedText::SavedText;

    void readMark(osgDB::ObjectMark& mark) override;
    void readWrappedString(std::string& text) override;
    bool matchString(const std::string& text) override;
    void advanceToCurrentEndBracket() override { leave(); }
    void finish() override;

protected:
    std::string nextWord() override;
    std::string nextName(const std::string& expected) override;

private:
    bool prepare();
    bool isAtEnd();
    bool takeElement();
    void leave();
    void leavePixels();
    void skipSpace();
    std::string takeName();
    std::string takeValue();
    void skipPast(const char* end);

    std::string _chunk, _attribute, _text; ///< what is read, and what comes after it
    std::size_t _next = 0;                 ///< in the chunk
    bool _isName = false;                  ///< the chunk, of an element
    std::size_t _depth = 0;                ///< of the element that was taken last
    bool _isClosed = false;                ///< it is, at once
    bool _isBehindPixels = false;          ///< what was read last, of a picture
    std::vector<std::size_t> _scopes;      ///< depths of the elements that brackets opened
};

} // namespace osgSkin

#endif
