//! A real camera, an image folder or a bag into /overhead/image_raw.
