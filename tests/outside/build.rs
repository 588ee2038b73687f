fn main() {
    landau_codegen::build::run();
}
