"""Image networks: architectures, ImageNet weights, training, Grad-CAM, and the hybrid network of both senses (T5)."""
