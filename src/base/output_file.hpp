#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace mcdbn {

/// Kind of output that a command may write to one place.
enum class OutputKind { file, file_or_folder };

/// A file, or a folder of files, that is written under a temporary name beside its place and put
/// there when it is whole. A reader of the place sees what was there before or all of the new.
/// A link is written through.
class OutputFile {
 public:
  /// Takes nothing from the disk yet.
  /// @throws InputError if the place is taken by a device, a pipe, an open file (/dev/stdout) or a
  /// folder with files, or by what an OutputBatch must not replace
  explicit OutputFile(const std::filesystem::path& path);
  /// Removes what was not put in place.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write: of the same extension and in the same folder as the place.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// At once, or with all others of the OutputBatch if there is one.
  /// @throws InputError, also if another of the batch has the same place, or a file would take that
  /// of a folder or was named as one, with a slash at its end
  void put_in_place();

 private:
  std::filesystem::path named_, path_, temporary_;
};

/// While it lives, the outputs that this thread writes wait beside their places, and
/// put_in_place() puts them all there: the outputs of a command come all or none, and replace no
/// file that it reads.
class OutputBatch {
 public:
  /// @param inputs files that will be read; what is none is passed over
  explicit OutputBatch(const std::vector<std::filesystem::path>& inputs = {});
  /// Removes what was not put in place, with the folders that were made for it.
  ~OutputBatch();
  OutputBatch(const OutputBatch&) = delete;
  OutputBatch& operator=(const OutputBatch&) = delete;

  /// @throws InputError if it is not all there now: one that failed undoes none before it
  void put_in_place();

 private:
  friend class OutputFile;
  friend class OutputsAtOnce;
  friend void make_folder(const std::filesystem::path& folder);
  friend void check_output(const std::filesystem::path& path, OutputKind kind);
  friend void note_input(const std::filesystem::path& path);
  friend void check_replaceable(const std::filesystem::path& path);

  struct Waiting {
    std::filesystem::path temporary, place;
  };
  /// Identity of a file, whatever its name: its device and its number there.
  using FileIdentity = std::pair<std::uintmax_t, std::uintmax_t>;
  static std::optional<FileIdentity> identity_of(const std::filesystem::path& path);
  static thread_local OutputBatch* current;

  std::set<FileIdentity> inputs_;
  std::vector<std::filesystem::path> made_folders_;
  std::set<std::filesystem::path> checked_, places_;
  std::vector<Waiting> waiting_;
};

/// While it lives, outputs are put in place at once, whatever batch there is: those that are there
/// to be read while the command runs, and those of it that have a way of their own to come all or
/// none.
class OutputsAtOnce {
 public:
  OutputsAtOnce() : held_back_(std::exchange(OutputBatch::current, nullptr)) {}
  ~OutputsAtOnce() { OutputBatch::current = held_back_; }
  OutputsAtOnce(const OutputsAtOnce&) = delete;
  OutputsAtOnce& operator=(const OutputsAtOnce&) = delete;

 private:
  OutputBatch* held_back_;
};

/// The file is read: the OutputBatch of this thread, if there is one, replaces it no more. To be
/// called for every file that is read (read_text_file does), also one found in a folder or a list.
void note_input(const std::filesystem::path& path);

/// @throws InputError if the place is taken by what is not to be replaced, as for OutputFile
void check_replaceable(const std::filesystem::path& path);

/// Kind of something that is not a regular file, in words: "a pipe".
std::string_view kind_of(std::filesystem::file_type type);

/// Checks what can be checked of an output before the work is done.
/// @throws InputError as OutputFile does, for a name that no file can have or that was looked at
/// before in this OutputBatch, for a folder, also one that is only named so, by a slash at its end,
/// where only a file can be written, and where the folder that it goes to does not exist or cannot
/// be written to
void check_output(const std::filesystem::path& path, OutputKind kind = OutputKind::file);

/// A new folder among temporary files, of a random name: at a name known beforehand another user
/// could have put a link. @return its place; empty if none can be made
std::filesystem::path make_temporary_folder();

/// The folder, and those that it lies in, unless they exist; through a link, where it leads.
/// @throws InputError
void make_folder(const std::filesystem::path& folder);

}  // namespace mcdbn
