# cmake -DROOT=<repository> -DOUTPUT=<file.cpp> -DFILES=<a;b;...> -P embed_sources.cmake
# Writes kernel_sources.cpp, so that names can be found in the source wherever the program runs.
set(entries "")
foreach(file ${FILES})
  file(READ ${ROOT}/${file} text)
  string(APPEND entries "    {\"${file}\",\n     R\"source(${text})source\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"hls/lowering/kernel_sources.h\"

namespace emax {
namespace {

struct Source {
  std::string_view path, text;
};
const Source kSources[] = {
${entries}};

const Source* find(std::string_view path) {
  for (const Source& source : kSources) {
    if (path.ends_with(source.path)) return &source;
  }
  return nullptr;
}

}  // namespace

std::string_view kernel_source(std::string_view path) {
  const Source* source = find(path);
  return source == nullptr ? std::string_view() : source->text;
}

std::string_view repository_path(std::string_view path) {
  const Source* source = find(path);
  return source == nullptr ? path : source->path;
}

}  // namespace emax
")
