// mutate_cad: a CAD file with one small mistake in it.
//
// usage: mutate_cad FILE SEED OUT
//
// FILE: STEP, IGES or BREP, by its extension, and OUT alike. SEED decides the kind (its remainder by 5: a
// vertex moved, an edge split near its end, a face offset, a sliver inserted, tolerances loosened), the place
// and how far (cad_mutations.hpp). Prints one line: what was done, and where. Tolerances are kept in BREP
// alone.
#include "benchmarks/cad_mutations.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>

namespace {

bool is_step(const std::string& file) {
  return file.ends_with(".step") || file.ends_with(".stp");
}
bool is_iges(const std::string& file) {
  return file.ends_with(".igs") || file.ends_with(".iges");
}

template <class Reader>
TopoDS_Shape transferred(Reader&& reader, const std::string& file) {
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw std::runtime_error("the file cannot be read");
  reader.TransferRoots();
  return reader.OneShape();
}

TopoDS_Shape read(const std::string& file) {
  if (is_step(file)) return transferred(STEPControl_Reader(), file);
  if (is_iges(file)) return transferred(IGESControl_Reader(), file);
  TopoDS_Shape shape;
  if (!BRepTools::Read(shape, file.c_str(), BRep_Builder()))
    throw std::runtime_error("the file cannot be read");
  return shape;
}

void write(const TopoDS_Shape& shape, const std::string& file) {
  bool written = false;
  if (is_step(file)) {
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    written = writer.Write(file.c_str()) == IFSelect_RetDone;
  } else if (is_iges(file)) {
    IGESControl_Writer writer("MM", 0);
    writer.AddShape(shape);
    writer.ComputeModel();
    written = writer.Write(file.c_str());
  } else {
    written = BRepTools::Write(shape, file.c_str());
  }
  if (!written) throw std::runtime_error("the file cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  using namespace aeroloom::mutations;
  if (argc != 4) {
    std::fprintf(stderr, "usage: mutate_cad FILE SEED OUT\n");
    return 2;
  }
  try {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    std::cout.setstate(std::ios::failbit);
    const int seed = std::atoi(argv[2]);
    std::mt19937 random(static_cast<unsigned>(seed));
    const Mutated mutated = mutate(read(argv[1]), static_cast<Mutation>(seed % mutation_count), random);
    write(mutated.shape, argv[3]);
    std::printf("%s\n", mutated.what.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mutate_cad: %s\n", error.what());
    return 1;
  } catch (const Standard_Failure& failure) {
    std::fprintf(stderr, "mutate_cad: %s\n", failure.GetMessageString());
    return 1;
  }
  return 0;
}
