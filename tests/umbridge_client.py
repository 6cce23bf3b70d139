"""The UM-Bridge client of PyPI (`pip install umbridge`) against a running service: python umbridge_client.py ADDRESS JOB"""

import sys

import umbridge

address, job = sys.argv[1:]
assert job in umbridge.supported_models(address)
model = umbridge.HTTPModel(address, job)
n, m = model.get_input_sizes()[0], model.get_output_sizes()[0]
assert model.supports_evaluate() and model.supports_gradient()
assert model.supports_apply_jacobian() and model.supports_apply_hessian()
x = [210.0, 92.0]
assert (n, m) == (2, 3)
loss = model([x])[0][0]
gradient = model.gradient(0, 0, [x], [1.0, 0.0, 0.0])
step = 1e-2
for j in range(n):
    low, high = list(x), list(x)
    low[j] -= step
    high[j] += step
    difference = (model([high])[0][0] - model([low])[0][0]) / (2 * step)
    assert abs(difference - gradient[j]) < 1e-3 * abs(gradient[j]), (j, difference, gradient[j])
along = model.apply_jacobian(0, 0, [x], [1.0, 0.0])
assert abs(along[0] - gradient[0]) < 1e-9 * abs(gradient[0])
curved = model.apply_hessian(0, 0, 0, [x], [1.0, 0.0, 0.0], [1.0, 0.0])
assert len(curved) == n
print(f"loss {loss:.3f} W, gradient {gradient}, Hessian column {curved}")
