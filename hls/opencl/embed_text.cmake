# cmake -DOUTPUT=<file.cpp> -DFILES=<a.cl;b.cl;...> -P embed_text.cmake
# Writes the texts, one after the other, as the result of opencl_text().
set(text "")
foreach(file ${FILES})
  file(READ ${file} part)
  string(APPEND text "R\"opencl(${part}\n)opencl\"\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"hls/opencl/opencl_text.h\"

namespace emax {

std::string_view opencl_text() {
  return ${text};
}

}  // namespace emax
")
