#include <mcdbn/device/device.hpp>

#include <iostream>

int main() {
  for (const mcdbn::DeviceInfo& device : mcdbn::list_devices()) std::cout << device.name << '\n';
}
