//! Full references of the laws and methods, by author and year.
//!
//! Details that are not certain are left out. Deliberately not here: who cites them.

/// Key and full reference, sorted by key.
pub(in crate::study) const REFERENCES: &[(&str, &str)] = &[
    (
        "ASTM D341",
        "ASTM D341: Standard practice for viscosity-temperature equations and charts for liquid petroleum or \
         hydrocarbon products. ASTM International",
    ),
    ("Archard 1953", "J. F. Archard: Contact and rubbing of flat surfaces. J. Appl. Phys. 24 (1953) 981-988"),
    (
        "Barus 1893",
        "C. Barus: Isothermals, isopiestics and isometrics relative to viscosity. Am. J. Sci. 45 (1893) \
         87-96",
    ),
    (
        "Booker 1965",
        "J. F. Booker: Dynamically loaded journal bearings: mobility method of solution. J. Basic Eng. 87 \
         (1965) 537-546",
    ),
    (
        "Broyden 1965",
        "C. G. Broyden: A class of methods for solving nonlinear simultaneous equations. Math. Comp. 19 \
         (1965) 577-593",
    ),
    (
        "Brugnano and Casulli 2008",
        "L. Brugnano, V. Casulli: Iterative solution of piecewise linear systems. SIAM J. Sci. Comput. 30 \
         (2008) 463-472",
    ),
    (
        "Brunt et al. 1998",
        "M. F. J. Brunt, H. Rai, A. L. Emtage: The calculation of heat release energy from engine cylinder \
         pressure data. SAE Technical Paper 981052 (1998)",
    ),
    (
        "Burley 2020",
        "B. Burley: Practical hash-based Owen scrambling. J. Comput. Graph. Tech. 9 (2020) no. 4",
    ),
    (
        "Carreau 1972",
        "P. J. Carreau: Rheological equations from molecular network theories. Trans. Soc. Rheol. 16 (1972) \
         99-127",
    ),
    ("Clarke 1983", "F. H. Clarke: Optimization and Nonsmooth Analysis. Wiley, New York 1983"),
    ("Cox 1972", "M. G. Cox: The numerical evaluation of B-splines. J. Inst. Math. Appl. 10 (1972) 134-149"),
    (
        "Cross 1965",
        "M. M. Cross: Rheology of non-Newtonian fluids: a new flow equation for pseudoplastic systems. J. \
         Colloid Sci. 20 (1965) 417-437",
    ),
    (
        "Dowson and Higginson 1966",
        "D. Dowson, G. R. Higginson: Elasto-hydrodynamic Lubrication: The Fundamentals of Roller and Gear \
         Lubrication. Pergamon Press, Oxford 1966",
    ),
    (
        "Fritsch and Carlson 1980",
        "F. N. Fritsch, R. E. Carlson: Monotone piecewise cubic interpolation. SIAM J. Numer. Anal. 17 \
         (1980) 238-246",
    ),
    (
        "Gear 1971",
        "C. W. Gear: Numerical Initial Value Problems in Ordinary Differential Equations. Prentice-Hall, \
         Englewood Cliffs 1971",
    ),
    (
        "Giacopini et al. 2010",
        "M. Giacopini, M. T. Fowell, D. Dini, A. Strozzi: A mass-conserving complementarity formulation to \
         study lubricant films in the presence of cavitation. J. Tribol. 132 (2010) 041702",
    ),
    (
        "Goldstein 1977",
        "A. A. Goldstein: Optimization of Lipschitz continuous functions. Math. Program. 13 (1977) 14-22",
    ),
    (
        "Goulart and Chen 2024",
        "P. J. Goulart, Y. Chen: Clarabel: an interior-point solver for conic programs with quadratic \
         objectives. arXiv 2405.12762 (2024)",
    ),
    (
        "Greenwood and Tripp 1971",
        "J. A. Greenwood, J. H. Tripp: The contact of two nominally flat rough surfaces. Proc. Instn Mech. \
         Engrs 185 (1970-1971) 625",
    ),
    (
        "Guembel 1914",
        "L. Guembel: Das Problem der Lagerreibung. Monatsblaetter des Berliner Bezirksvereins Deutscher \
         Ingenieure (1914)",
    ),
    (
        "Hestenes 1969",
        "M. R. Hestenes: Multiplier and gradient methods. J. Optim. Theory Appl. 4 (1969) 303-320",
    ),
    (
        "Heun 1900",
        "K. Heun: Neue Methoden zur approximativen Integration der Differentialgleichungen einer \
         unabhaengigen Veraenderlichen. Z. Math. Phys. 45 (1900) 23-38",
    ),
    ("Heywood 1988", "J. B. Heywood: Internal Combustion Engine Fundamentals. McGraw-Hill, New York 1988"),
    (
        "Hu et al. 1994",
        "Y. Hu, H. S. Cheng, T. Arai, Y. Kobayashi, S. Aoyama: Numerical simulation of piston ring in mixed \
         lubrication: a nonaxisymmetrical analysis. J. Tribol. 116 (1994) 470-478",
    ),
    (
        "Jakobsson and Floberg 1957",
        "B. Jakobsson, L. Floberg: The finite journal bearing, considering vaporization. Trans. Chalmers \
         Univ. Technol. 190 (1957)",
    ),
    (
        "McKay et al. 1979",
        "M. D. McKay, R. J. Beckman, W. J. Conover: A comparison of three methods for selecting values of \
         input variables in the analysis of output from a computer code. Technometrics 21 (1979) 239-245",
    ),
    (
        "Nocedal and Wright 2006",
        "J. Nocedal, S. J. Wright: Numerical Optimization. 2nd ed., Springer, New York 2006",
    ),
    (
        "Ocvirk 1952",
        "F. W. Ocvirk: Short-bearing approximation for full journal bearings. NACA Technical Note 2808 \
         (1952)",
    ),
    (
        "Olsson 1965",
        "K.-O. Olsson: Cavitation in dynamically loaded bearings. Trans. Chalmers Univ. Technol. 308 (1965)",
    ),
    (
        "Owen 1995",
        "A. B. Owen: Randomly permuted (t,m,s)-nets and (t,s)-sequences. In: Monte Carlo and Quasi-Monte Carlo Methods in Scientific Computing, Lecture Notes in Statistics 106, Springer, New York 1995, 299-317",
    ),
    (
        "Patir and Cheng 1978",
        "N. Patir, H. S. Cheng: An average flow model for determining effects of three-dimensional roughness \
         on partial hydrodynamic lubrication. J. Lubr. Technol. 100 (1978) 12",
    ),
    (
        "Patir and Cheng 1979",
        "N. Patir, H. S. Cheng: Application of average flow model to lubrication between rough sliding \
         surfaces. J. Lubr. Technol. 101 (1979) 220",
    ),
    ("Piegl and Tiller 1997", "L. Piegl, W. Tiller: The NURBS Book. 2nd ed., Springer, Berlin 1997"),
    (
        "Powell 1969",
        "M. J. D. Powell: A method for nonlinear constraints in minimization problems. In: R. Fletcher \
         (ed.), Optimization, Academic Press, London 1969, 283-298",
    ),
    (
        "Powell 1978",
        "M. J. D. Powell: A fast algorithm for nonlinearly constrained optimization calculations. In: \
         Numerical Analysis, Lecture Notes in Mathematics 630, Springer, Berlin 1978, 144-157",
    ),
    (
        "Powell 1994",
        "M. J. D. Powell: A direct search optimization method that models the objective and constraint \
         functions by linear interpolation. In: Advances in Optimization and Numerical Analysis, Kluwer, \
         Dordrecht 1994, 51-67",
    ),
    (
        "Reynolds 1886",
        "O. Reynolds: On the theory of lubrication and its application to Mr. Beauchamp Tower's experiments, \
         including an experimental determination of the viscosity of olive oil. Phil. Trans. R. Soc. 177 \
         (1886) 157-234",
    ),
    (
        "Roelands 1966",
        "C. J. A. Roelands: Correlational aspects of the viscosity-temperature-pressure relationship of \
         lubricating oils. Thesis, Delft University of Technology 1966",
    ),
    (
        "Saad and Schultz 1986",
        "Y. Saad, M. H. Schultz: GMRES: a generalized minimal residual algorithm for solving nonsymmetric \
         linear systems. SIAM J. Sci. Stat. Comput. 7 (1986) 856-869",
    ),
    (
        "Sirovich 1987",
        "L. Sirovich: Turbulence and the dynamics of coherent structures, part I: coherent structures. Q. \
         Appl. Math. 45 (1987) 561-571",
    ),
    (
        "Sobol 1967",
        "I. M. Sobol: On the distribution of points in a cube and the approximate evaluation of integrals. USSR Comput. Math. Math. Phys. 7 (1967) no. 4, 86-112",
    ),
    (
        "Sommerfeld 1904",
        "A. Sommerfeld: Zur hydrodynamischen Theorie der Schmiermittelreibung. Z. Math. Phys. 50 (1904) \
         97-155",
    ),
    ("Stieber 1933", "W. Stieber: Das Schwimmlager. VDI-Verlag, Berlin 1933"),
    (
        "Swift 1932",
        "H. W. Swift: The stability of lubricating films in journal bearings. Minutes Proc. Instn Civ. Engrs \
         233 (1932) 267-288",
    ),
    (
        "Vogel 1921",
        "H. Vogel: Das Temperaturabhaengigkeitsgesetz der Viskositaet von Fluessigkeiten. Phys. Z. 22 (1921) \
         645-646",
    ),
    ("Walther 1931", "C. Walther: Ueber die Auswertung von Viskositaetsangaben. Erdoel und Teer 7 (1931)"),
    (
        "Wiebe 1970",
        "I. I. Wiebe: Brennverlauf und Kreisprozess von Verbrennungsmotoren. VEB Verlag Technik, Berlin 1970",
    ),
    (
        "Wu and Zheng 1989",
        "C. Wu, L. Zheng: An average Reynolds equation for partial film lubrication with a contact factor. \
         J. Tribol. 111 (1989) 188-191",
    ),
    ("de Boor 1972", "C. de Boor: On calculating with B-splines. J. Approx. Theory 6 (1972) 50-62"),
    ("de Boor 1978", "C. de Boor: A Practical Guide to Splines. Springer, New York 1978"),
];

/// The full reference of a key.
pub(in crate::study) fn full(key: &str) -> Option<&'static str> {
    REFERENCES.iter().find(|(k, _)| *k == key).map(|(_, text)| *text)
}

#[cfg(test)]
mod tests {
    use super::REFERENCES;

    #[test]
    fn keys_are_sorted_and_their_years_stand_in_the_reference() {
        assert!(REFERENCES.windows(2).all(|pair| pair[0].0 < pair[1].0));
        for (key, text) in REFERENCES {
            let last = key.rsplit(' ').next().unwrap();
            assert!(text.contains(last), "{key}: {text}");
            assert!(text.is_ascii() && !text.ends_with('.') && !text.contains("  "), "{text}");
        }
    }
}
