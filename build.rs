//! How the program with HDF5 linked in is linked.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let is = |name: &str, value: &str| std::env::var(name).is_ok_and(|it| it == value);
    if std::env::var_os("CARGO_FEATURE_STATIC_HDF5").is_some()
        && is("CARGO_CFG_TARGET_OS", "linux")
        && is("CARGO_CFG_TARGET_ENV", "gnu")
    {
        // At a fixed address 19,000 addresses need not be filled in at each start, which took a fifth of the time of `fretwear --version`.
        println!("cargo::rustc-link-arg-bins=-no-pie");
    }
}
