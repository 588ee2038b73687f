fn main() -> std::process::ExitCode {
    landau_solver::cli::run(landau_spec::models())
}
