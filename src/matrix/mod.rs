//! Polynomial matrices and the Faddeev-LeVerrier recursion.
