// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDXML_H
#define OSGSKINIMPORT_SAVEDXML_H 1

#include "saved/SavedText.h"

#include <cstddef>
#include <string>

namespace osgSkin {

/// The layout of `.osgx` files: of each element its name, its attributes `attribute` and `text`,
/// then the elements within it. What closes elements has no meaning.
class SavedXml : public SavedText {
public:
    using SavedText::SavedText;

    void readMark(osgDB::ObjectMark& mark) override;
    void readWrappedString(std::string& text) override;
    bool matchString(const std::string& text) override;
    /// Nothing skips an element that its object does not know: all after it is left.
    void finish() override;

protected:
    std::string nextWord() override;
    std::string nextName(const std::string& expected) override;

private:
    bool prepare();
    bool takeElement();
    void skipSpace();
    std::string takeName();
    std::string takeValue();
    void skipPast(const char* end);

    std::string _chunk, _attribute, _text; ///< what is read, and what comes after it
    std::size_t _next = 0;                 ///< in the chunk
};

} // namespace osgSkin

#endif
