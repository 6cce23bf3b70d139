//! The inner loops: rank-`P` updates of rows, four dot products at once, and the choice of machine instructions.
//!
//! Loops run over arrays of four, which the compiler turns into vector instructions. A plain build may only assume SSE2;
//! [`fastest`] therefore compiles each job twice and picks AVX2 with fused multiply-add where the processor has it.

/// `c - a b`, rounded once or twice.
pub(in crate::math) trait Arithmetic {
    fn minus(c: f64, a: f64, b: f64) -> f64;
}

pub(in crate::math) struct Plain;
pub(in crate::math) struct Fused;

impl Arithmetic for Plain {
    #[inline(always)]
    fn minus(c: f64, a: f64, b: f64) -> f64 {
        c - a * b
    }
}

impl Arithmetic for Fused {
    #[inline(always)]
    fn minus(c: f64, a: f64, b: f64) -> f64 {
        (-a).mul_add(b, c)
    }
}

/// Work that can be compiled for either [`Arithmetic`]; `run` and all it calls must be `#[inline(always)]`.
pub(in crate::math) trait Job {
    type Output;
    fn run<A: Arithmetic>(self) -> Self::Output;
}

/// Runs `job` with the best instructions of this processor; the choice is the same for every call on one machine.
pub(in crate::math) fn fastest<J: Job>(job: J) -> J::Output {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn fused<J: Job>(job: J) -> J::Output {
            job.run::<Fused>()
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor was just found to have both features, which is all that `fused` asks for.
            return unsafe { fused(job) };
        }
    }
    job.run::<Plain>()
}

/// Four rows of `n` entries; row `q` starts at `at - q * skew` of its storage of `w`.
#[inline(always)]
pub(super) fn four(storage: &[f64], w: usize, at: usize, skew: usize, n: usize) -> [&[f64]; 4] {
    let row = |q: usize| {
        let at = q * w + at - q * skew;
        &storage[at..at + n]
    };
    [row(0), row(1), row(2), row(3)]
}

/// `y_r -= sum_p m_rp u_p` for `R` rows at once, so that each `u` is loaded once for all of them.
#[inline(always)]
pub(super) fn update<A: Arithmetic, const P: usize, const R: usize>(
    y: [&mut [f64]; R],
    m: [[f64; P]; R],
    u: [&[f64]; P],
) {
    let n = u[0].len();
    if n == 0 {
        return;
    }
    let u = u.map(|u| u[..n].as_chunks::<4>());
    let y = y.map(|y| y[..n].as_chunks_mut::<4>());
    for c in 0..n / 4 {
        // Everything is read before anything is written: the compiler cannot know that `u` and `y` lie apart.
        let mut v = [[0.0; 4]; R];
        for r in 0..R {
            v[r] = y[r].0[c];
        }
        for p in 0..P {
            let row = u[p].0[c];
            for r in 0..R {
                for lane in 0..4 {
                    v[r][lane] = A::minus(v[r][lane], m[r][p], row[lane]);
                }
            }
        }
        for r in 0..R {
            y[r].0[c] = v[r];
        }
    }
    for c in 0..n % 4 {
        for r in 0..R {
            for p in 0..P {
                y[r].1[c] = A::minus(y[r].1[c], m[r][p], u[p].1[c]);
            }
        }
    }
}

/// `t_q -= a_q . x` for four rows at once: the partial sums do not wait for each other and `x` is loaded once.
#[inline(always)]
pub(super) fn minus_dots<A: Arithmetic>(t: &mut [f64; 4], a: [&[f64]; 4], x: &[f64]) {
    let n = x.len();
    if n == 0 {
        return;
    }
    let a = a.map(|a| a[..n].as_chunks::<4>());
    let (x4, rest) = x.as_chunks::<4>();
    let mut sums = [[0.0; 4]; 4];
    for (c, x) in x4.iter().enumerate() {
        for q in 0..4 {
            for lane in 0..4 {
                sums[q][lane] = A::minus(sums[q][lane], a[q].0[c][lane], x[lane]);
            }
        }
    }
    // Without this detour through memory the compiler regroups the sums by rows and spends its time on shuffles.
    let sums = std::hint::black_box(sums);
    for q in 0..4 {
        t[q] += (sums[q][0] + sums[q][1]) + (sums[q][2] + sums[q][3]);
    }
    for (c, x) in rest.iter().enumerate() {
        for q in 0..4 {
            t[q] = A::minus(t[q], a[q].1[c], *x);
        }
    }
}
