fn main() -> std::process::ExitCode {
    landau_cli::run(landau_spec::models())
}
