// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDBINARY_H
#define OSGSKINIMPORT_SAVEDBINARY_H 1

#include "saved/SavedInput.h"

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// The layout of `.osgb` files, of either byte order.
class SavedBinary : public SavedInput {
public:
    using SavedInput::SavedInput;

    /// Whether bytes begin as those of a binary file do.
    static bool begins(const std::string& content);
    /// Reads past that beginning. Files that are compressed or bring classes' layouts with them are
    /// refused: OSG takes as much memory as the former ask for, and believes the latter for all
    /// files to come.
    void skipBeginning();

    bool isBinary() const override { return true; }
    void readBool(bool& value) override { value = take<char>() != 0; }
    void readChar(char& value) override { value = take<char>(); }
    void readSChar(signed char& value) override { value = take<signed char>(); }
    void readUChar(unsigned char& value) override { value = take<unsigned char>(); }
    void readShort(short& value) override { value = take<short>(); }
    void readUShort(unsigned short& value) override { value = take<unsigned short>(); }
    void readInt(int& value) override { value = took(take<int>()); }
    void readUInt(unsigned& value) override { value = took(take<unsigned>()); }
    void readLong(long& value) override { value = take<std::int32_t>(); }
    void readULong(unsigned long& value) override { value = take<std::uint32_t>(); }
    void readFloat(float& value) override { value = take<float>(); }
    void readDouble(double& value) override { value = take<double>(); }
    void readString(std::string& value) override { value = took(takeText()); }
    void readStream(std::istream& (*)(std::istream&)) override {}
    void readBase(std::ios_base& (*)(std::ios_base&)) override {}
    void readGLenum(osgDB::ObjectGLenum& value) override { value.set(take<unsigned>()); }
    void readProperty(osgDB::ObjectProperty& property) override;
    void readMark(osgDB::ObjectMark& mark) override;
    void readCharArray(char* bytes, unsigned size) override;
    void readWrappedString(std::string& text) override { text = tookWrapped(takeText()); }
    void advanceToCurrentEndBracket() override;

private:
    template <typename Number>
    Number take() {
        Number number = 0;
        takeBytes(reinterpret_cast<char*>(&number), sizeof number, _byteSwap != 0);
        return number;
    }
    void takeBytes(char* bytes, std::size_t size, bool swapped);
    std::string takeText();

    std::vector<std::size_t> _ends; ///< of the blocks that are being read
};

} // namespace osgSkin

#endif
