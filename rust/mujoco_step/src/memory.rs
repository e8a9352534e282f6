//! The simulator's own numbers, which its functions change between two looks.

use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// An array of MuJoCo's data, known by its place. It lives as long as the data object, whose owner keeps that alive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LiveArray<T> {
    first: *mut T,
    length: usize,
    /// From one number to the next, in numbers.
    stride: usize,
}

impl<T: numpy::Element + Copy> LiveArray<T> {
    /// The array behind an attribute of a data object, which is a view of the object's own memory.
    pub(crate) fn of(owner: &Bound<'_, PyAny>, name: &str) -> PyResult<Self> {
        let attribute = owner.getattr(name)?;
        let array = attribute.cast::<PyArrayDyn<T>>()?;
        let size = isize::try_from(size_of::<T>())?;
        let stride = match array.strides() {
            [stride] if stride % size == 0 && *stride > 0 => usize::try_from(stride / size)?,
            _ => return Err(PyTypeError::new_err(format!("{name} must be a vector"))),
        };
        Ok(Self {
            first: array.data(),
            length: array.len(),
            stride,
        })
    }

    /// How many numbers there are.
    pub(crate) const fn len(&self) -> usize {
        self.length
    }

    /// One number; None outside.
    pub(crate) fn get(&self, index: usize) -> Option<T> {
        if index >= self.length {
            return None;
        }
        // SAFETY: the index is inside of the array.
        let place = unsafe { self.first.add(index * self.stride) };
        // SAFETY: the array is numpy's view of MuJoCo's live memory, aligned for its type; no reference to it exists, and nothing else
        // writes while `Physics` is borrowed mutably.
        Some(unsafe { place.read() })
    }

    /// Sets one number; outside nothing happens.
    pub(crate) fn set(&mut self, index: usize, value: T) {
        if index < self.length {
            // SAFETY: the index is inside of the array.
            let place = unsafe { self.first.add(index * self.stride) };
            // SAFETY: as for reading; `Physics` is borrowed mutably.
            unsafe { place.write(value) };
        }
    }

    /// Copies all numbers into a row of the same length.
    pub(crate) fn copy_to(&self, row: &mut [T]) {
        for (index, slot) in row.iter_mut().enumerate() {
            if let Some(value) = self.get(index) {
                *slot = value;
            }
        }
    }

    /// All numbers, one after the other.
    pub(crate) fn iter(&self) -> impl Iterator<Item = T> + '_ {
        (0..self.length).filter_map(|index| self.get(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(numbers: &mut [f64], stride: usize) -> LiveArray<f64> {
        LiveArray {
            first: numbers.as_mut_ptr(),
            length: numbers.len() / stride,
            stride,
        }
    }

    #[test]
    fn numbers_are_read_and_set_in_place_and_none_outside() {
        let mut numbers = [1.0, 2.0, 3.0, 4.0];
        let mut memory = over(&mut numbers, 1);
        assert_eq!(memory.len(), 4);
        assert_eq!((memory.get(3), memory.get(4)), (Some(4.0), None));
        memory.set(0, 9.0);
        memory.set(4, 9.0);
        let mut row = [0.0; 4];
        memory.copy_to(&mut row);
        assert_eq!(row, [9.0, 2.0, 3.0, 4.0]);
        assert_eq!(numbers, row);
    }

    #[test]
    fn every_second_number_is_read_where_the_stride_says_so() {
        let mut numbers = [1.0, 2.0, 3.0, 4.0];
        let memory = over(&mut numbers, 2);
        assert_eq!(memory.iter().collect::<Vec<_>>(), [1.0, 3.0]);
    }
}
