//! Registers of 256 and 512 bits, which kernels of products leave in use.

/// Tells the processor that the upper halves of wide registers are free.
///
/// The kernels in assembly that faer multiplies with (private-gemm-x86 0.1.22) do not. On processors since Ice Lake each change between instructions for
/// narrow registers in their old and new encodings then takes some 30 ns, and a function of the C library makes two: `exp` took ten times as long until
/// the registers were freed by chance.
#[inline]
pub(super) fn leave_registers() {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx") {
        // SAFETY: the processor has the instruction.
        unsafe { zero_upper_halves() }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx")]
fn zero_upper_halves() {
    std::arch::x86_64::_mm256_zeroupper();
}
